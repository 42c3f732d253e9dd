#include "rig/rig_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/error.h"
#include "rig/rig_description.h"
#include "rig/toml_table.h"
#include "temporary_folder.h"

namespace lumitexel {
namespace {

class RigFileTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  TemporaryFolder folder_;
};

TEST_F(RigFileTest, WithoutABaseItIsTheFileByteForByte) {
  const std::string text = "# a comment\nname = \"x\"\n";
  EXPECT_EQ(read_rig_file(write("a.toml", text)), text);
}

// A folder that is not named is the current one.
TEST_F(RigFileTest, PathsAreRelativeToAFileNamedWithoutItsFolder) {
  write("a.toml", "name = \"a\"\n");
  write("b.toml", "base = \"a.toml\"\n[recorded]\nsession = \"S\"\n");
  const struct ThereAndBack {
    explicit ThereAndBack(const std::filesystem::path& there) { std::filesystem::current_path(there); }
    ~ThereAndBack() { std::filesystem::current_path(back); }
    std::filesystem::path back = std::filesystem::current_path();
  } there(folder_.path());
  const std::string merged = read_rig_file("b.toml");
  EXPECT_NE(merged.find((std::filesystem::canonical(folder_.path()) / "S").string()), std::string::npos) << merged;
}

TEST_F(RigFileTest, KeysLieOverTheBasesAndTheRestStays) {
  write("a.toml", "name = \"a\"\n[camera]\nbits = 12\nreadout_s = 0.5\n[ring_flash]\nradius_m = 0.04\n");
  write("b.toml", "base = \"a.toml\"\nname = \"b\"\n[camera]\nbits = 14\n");
  const TomlTable table = TomlTable::parse(read_rig_file(write("c.toml", "base = \"b.toml\"\n[extra]\nx = 1e-6\n")), "c");
  EXPECT_FALSE(table.has("base"));
  EXPECT_EQ(table.string("name"), "b");
  EXPECT_EQ(table.table("camera").integer("bits", 1, 16), 14);
  EXPECT_EQ(table.table("camera").number("readout_s", NumberRange::finite()), 0.5);
  EXPECT_EQ(table.table("ring_flash").number("radius_m", NumberRange::finite()), 0.04);
  EXPECT_EQ(table.table("extra").number("x", NumberRange::finite()), 1e-6);
}

TEST_F(RigFileTest, ATableThatReplacesKeepsNothingOfTheOther) {
  write("a.toml", "name = \"a\"\n[hardware.camera]\naddress = \"127.0.0.2\"\n[hardware.table]\nx = 1\n");
  const TomlTable hardware =
      TomlTable::parse(read_rig_file(write("b.toml", "base = \"a.toml\"\n[hardware.camera]\nreplaces = true\n"
                                                     "port = \"usb:\"\n")), "b").table("hardware");
  EXPECT_EQ(hardware.table("camera").keys(), std::vector<std::string>{"port"});
  EXPECT_TRUE(hardware.has("table"));
}

TEST_F(RigFileTest, FilesThatCannotBeUsedAreRefused) {
  EXPECT_THROW(read_rig_file(write("self.toml", "base = \"self.toml\"\n")), BadInput);
  EXPECT_THROW(read_rig_file(write("gone.toml", "base = \"nowhere.toml\"\n")), BadInput);
  EXPECT_THROW(read_rig_file(write("number.toml", "base = 3\n")), BadInput);
  EXPECT_THROW(read_rig_file(write("broken.toml", "base = \n")), BadInput);
}

TEST_F(RigFileTest, NumbersSurviveTheMergeToTheLastBit) {
  const std::filesystem::path rig = std::filesystem::path(LUMITEXEL_SOURCE_DIR) / "config/rigs/simulated.toml";
  const std::string merged = read_rig_file(write("over.toml", "base = \"" + rig.string() + "\"\nname = \"over\"\n"));
  const RigDescription a = parse_rig(read_rig_file(rig), "a"), b = parse_rig(merged, "b");
  EXPECT_EQ(b.name, "over");
  EXPECT_EQ(a.camera.camera_from_rig.matrix(), b.camera.camera_from_rig.matrix());
  EXPECT_EQ(a.camera.lens.k1, b.camera.lens.k1);
  EXPECT_EQ(a.camera.limits.exposure_step_s, b.camera.limits.exposure_step_s);
}

}  // namespace
}  // namespace lumitexel
