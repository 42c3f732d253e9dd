// [hardware.camera] with driver = "aravis".
#include <gtest/gtest.h>

#include "rig/hardware_description.h"
#include "rig/toml_table.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

AravisConnection read(const std::string& lines) {
  return read_aravis_connection(TomlTable::parse("driver = \"aravis\"\n" + lines, "rig.toml"));
}

TEST(AravisConnection, IsReadWholly) {
  const AravisConnection connection = read(
      "address = \"192.168.1.7\"\npixel_format = \"BayerRG16\"\nregion_x_px = 4\nregion_y_px = 6\n"
      "packet_size_bytes = 1500\nframe_name_feature = \"UserValue\"\nframe_name_chunk = \"ChunkUserValue\"\n"
      "temperature_feature = \"SensorTemperature\"\nanswer_timeout_s = 2\nreconnect_timeout_s = 7.5\n");
  EXPECT_EQ(connection.address, "192.168.1.7");
  EXPECT_EQ(connection.pixel_format, "BayerRG16");
  EXPECT_EQ(connection.region_x_px, 4);
  EXPECT_EQ(connection.region_y_px, 6);
  EXPECT_EQ(connection.packet_size_bytes, 1500);
  EXPECT_EQ(connection.frame_name_feature, "UserValue");
  EXPECT_EQ(connection.frame_name_chunk, "ChunkUserValue");
  EXPECT_EQ(connection.temperature_feature, "SensorTemperature");
  EXPECT_EQ(connection.answer_timeout_s, 2.0);
  EXPECT_EQ(connection.reconnect_timeout_s, 7.5);
}

TEST(AravisConnection, NeedsNothingButAnAddress) {
  const AravisConnection connection = read("address = \"10.0.0.1\"\n");
  EXPECT_EQ(connection.packet_size_bytes, 9000);
  EXPECT_TRUE(connection.frame_name_feature.empty());
}

TEST(AravisConnection, NamesLineAndKeyOfAMistake) {
  EXPECT_BAD_INPUT(read(""), "rig.toml", "address", "missing");
  EXPECT_BAD_INPUT(read("address = \"a\"\npacket_size_bytes = 10\n"), "rig.toml:3", "packet_size_bytes", "10", "576");
  EXPECT_BAD_INPUT(read("address = \"a\"\nregion_x_px = -1\n"), "region_x_px", "-1");
  EXPECT_BAD_INPUT(read("address = \"a\"\nanswer_timeout_s = 0\n"), "answer_timeout_s", "positive");
  EXPECT_BAD_INPUT(read("address = \"a\"\nreconnect_timeout_s = nan\n"), "reconnect_timeout_s");
  EXPECT_BAD_INPUT(read("address = \"a\"\npacketsize = 10\n"), "packetsize", "unknown key");
  EXPECT_BAD_INPUT(read("address = \"a\"\nframe_name_chunk = \"ChunkX\"\n"), "frame_name_chunk", "together");
}

}  // namespace
}  // namespace lumitexel
