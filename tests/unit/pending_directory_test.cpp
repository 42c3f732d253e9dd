#include "rig/pending_directory.h"

#include <gtest/gtest.h>

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

TEST(ReplaceDirectory, AFolderThatCannotBePutInPlaceLeavesTheOldOne) {
  const TemporaryFolder folder;
  make_old(folder / "levels");
  EXPECT_THROW(replace_directory(folder / "missing", folder / "levels"), Error);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"levels"});
  EXPECT_EQ(names_in(folder / "levels"), std::vector<std::string>{"old"});
}

}  // namespace
}  // namespace lumitexel
