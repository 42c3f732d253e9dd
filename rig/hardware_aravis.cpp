#include "rig/hardware_description.h"
#include "rig/toml_table.h"

namespace lumitexel {
namespace {

constexpr int kLargestCoordinate_px = 65534;
constexpr int kSmallestPacket_bytes = 576, kLargestPacket_bytes = 65532;  // GigE Vision's range

}  // namespace

AravisConnection read_aravis_connection(const TomlTable& table) {
  AravisConnection connection;
  if (table.string("driver") != "aravis") table.reject("driver", table.string("driver"), "\"aravis\"");
  connection.address = table.string("address");
  const auto text = [&](const char* key, std::string& value) {
    if (table.has(key)) value = table.string(key);
  };
  const auto whole = [&](const char* key, int min, int max, int& value) {
    if (table.has(key)) value = table.integer(key, min, max);
  };
  const auto seconds = [&](const char* key, double& value) {
    if (table.has(key)) value = table.number(key, NumberRange::positive());
  };
  text("pixel_format", connection.pixel_format);
  whole("region_x_px", 0, kLargestCoordinate_px, connection.region_x_px);
  whole("region_y_px", 0, kLargestCoordinate_px, connection.region_y_px);
  whole("packet_size_bytes", kSmallestPacket_bytes, kLargestPacket_bytes, connection.packet_size_bytes);
  text("frame_name_feature", connection.frame_name_feature);
  text("frame_name_chunk", connection.frame_name_chunk);
  text("temperature_feature", connection.temperature_feature);
  seconds("answer_timeout_s", connection.answer_timeout_s);
  seconds("reconnect_timeout_s", connection.reconnect_timeout_s);
  if (connection.frame_name_feature.empty() != connection.frame_name_chunk.empty()) {
    const bool no_feature = connection.frame_name_feature.empty();
    table.reject(no_feature ? "frame_name_chunk" : "frame_name_feature", "given alone",
                 "frame_name_feature and frame_name_chunk together, or neither");
  }
  table.reject_unread();
  return connection;
}

}  // namespace lumitexel
