#include <gtest/gtest.h>

#include "rig/hardware_description.h"
#include "rig/toml_table.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

GphotoConnection read(const std::string& lines) {
  return read_gphoto_connection(TomlTable::parse("[hardware.camera]\ndriver = \"gphoto2\"\n" + lines, "rig.toml")
                                    .table("hardware")
                                    .table("camera"));
}

TEST(GphotoConnection, IsReadWhole) {
  const GphotoConnection connection = read(R"(
model = "PTP/IP Camera"
port = "ptpip:127.0.0.1:15740:15741"
exposure_setting = "shutterspeed2"
gain_setting = "iso2"
frame_name_setting = "501e"
iso_at_0_db = 64
answer_timeout_s = 3.5
reconnect_timeout_s = 7
[hardware.camera.fixed_settings]
imagequality = "RAW"
"f-number" = "f/8"
)");
  EXPECT_EQ(connection.model, "PTP/IP Camera");
  EXPECT_EQ(connection.port, "ptpip:127.0.0.1:15740:15741");
  EXPECT_EQ(connection.exposure_setting, "shutterspeed2");
  EXPECT_EQ(connection.gain_setting, "iso2");
  EXPECT_EQ(connection.frame_name_setting, "501e");
  EXPECT_EQ(connection.iso_at_0_db, 64.0);
  EXPECT_EQ(connection.answer_timeout_s, 3.5);
  EXPECT_EQ(connection.reconnect_timeout_s, 7.0);
  EXPECT_EQ(connection.fixed_settings,
            (std::map<std::string, std::string>{{"imagequality", "RAW"}, {"f-number", "f/8"}}));
}

TEST(GphotoConnection, NeedsNothingOnUsb) {
  const GphotoConnection connection = read("");
  EXPECT_EQ(connection.port, "usb:");
  EXPECT_EQ(connection.model, "");
  EXPECT_TRUE(connection.fixed_settings.empty());
}

TEST(GphotoConnection, MistakesAreNamedWithLineAndKey) {
  EXPECT_BAD_INPUT(read("prot = \"usb:\""), "rig.toml:3", "hardware.camera.prot");
  EXPECT_BAD_INPUT(read("port = \"/dev/usb\""), "rig.toml:3", "hardware.camera.port", "/dev/usb");
  EXPECT_BAD_INPUT(read("port = 3"), "rig.toml:3", "port");
  EXPECT_BAD_INPUT(read("port = \"ptpip:1.2.3.4\""), "hardware.camera.model", "missing");
  EXPECT_BAD_INPUT(read("model = \"PTP/IP Camera\"\nport = \"ptpip:1.2.3.4:15740\""), "rig.toml:4", "EVENT_PORT");
  EXPECT_BAD_INPUT(read("answer_timeout_s = 0"), "rig.toml:3", "answer_timeout_s", "positive");
  EXPECT_BAD_INPUT(read("iso_at_0_db = nan"), "rig.toml:3", "iso_at_0_db");
  EXPECT_BAD_INPUT(read("[hardware.camera.fixed_settings]\nimagequality = 3"), "rig.toml:4", "imagequality");
  EXPECT_BAD_INPUT(read_gphoto_connection(TomlTable::parse("driver = \"aravis\"", "rig.toml")), "driver", "aravis");
}

}  // namespace
}  // namespace lumitexel
