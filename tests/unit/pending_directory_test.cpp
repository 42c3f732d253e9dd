#include "rig/pending_directory.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "drivers/error.h"
#include "rig/replace_directory.h"
#include "rig/whole_file.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

void make_old(const fs::path& target) {
  fs::create_directory(target);
  write_whole_file(target / "old", "1");
}

TEST(PendingDirectory, TakesThePlaceOfWhatWasThereAsAWhole) {
  const TemporaryFolder folder;
  make_old(folder / "levels");
  {
    PendingDirectory pending(folder / "levels/");
    write_whole_file(pending.path() / "new", "2");
    EXPECT_THROW(pending.move_into_place(), Error) << "which replaces nothing";
    EXPECT_EQ(names_in(folder / "levels"), std::vector<std::string>{"old"});
    pending.replace_target();
  }
  EXPECT_EQ(names_in(folder / "levels"), std::vector<std::string>{"new"});
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"levels"});
}

TEST(PendingDirectory, WithoutThatEverythingStaysAsItWas) {
  const TemporaryFolder folder;
  make_old(folder / "levels");
  { const PendingDirectory pending(folder / "levels"), deeper(folder / "a/b/c"); }
  EXPECT_EQ(names_in(folder / "levels"), std::vector<std::string>{"old"});
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"levels"});
}

// A process that ends without its destructors, as a killed one does; its folder's number is then nobody's.
void begin_and_die(const fs::path& target) {
  const pid_t child = fork();
  if (child == 0) {
    const PendingDirectory pending(target);
    std::_Exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
}

TEST(PendingDirectory, RemovesWhatAKilledProcessLeftAndNothingElse) {
  const TemporaryFolder folder;
  begin_and_die(folder / "levels");
  begin_and_die(folder / "other");
  const std::string living = ".levels.partial-" + std::to_string(getppid());
  for (const std::string& name : {living, std::string(".levels.partial-"), std::string(".levels.partial-12x")}) fs::create_directory(folder / name);
  ASSERT_EQ(names_in(folder.path()).size(), 5u);
  { const PendingDirectory pending(folder / "levels"); }
  const std::vector<std::string> left = names_in(folder.path());
  EXPECT_EQ(left.size(), 4u) << "the other target's, one of a living process, and two that only look alike";
  EXPECT_TRUE(fs::exists(folder / living));
}

TEST(ReplaceDirectory, AFolderThatCannotBePutInPlaceLeavesTheOldOne) {
  const TemporaryFolder folder;
  make_old(folder / "levels");
  EXPECT_THROW(replace_directory(folder / "missing", folder / "levels"), Error);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"levels"});
  EXPECT_EQ(names_in(folder / "levels"), std::vector<std::string>{"old"});
}

}  // namespace
}  // namespace lumitexel
