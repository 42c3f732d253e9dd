// How to reach a GigE Vision or USB3 Vision camera, and what to set on it once.
#pragma once

#include <string>

namespace lumitexel {

struct AravisConnection {
  std::string address;               // an IP address, or "VENDOR-MODEL-SERIAL" for USB3 Vision
  std::string pixel_format;          // GenICam's name: "Mono12", "BayerRG16", …; empty: whatever suits the rig's bits and mosaic
  int region_x_px = 0, region_y_px = 0;  // the region's corner; its size is the rig's
  int packet_size_bytes = 9000;
  // An integer feature that the camera copies into each frame's chunk data under the name `frame_name_chunk`: a frame
  // then proves by itself which shot it is. Both empty: not used.
  std::string frame_name_feature, frame_name_chunk;
  std::string temperature_feature = "DeviceTemperature";  // read if the camera has it
  double answer_timeout_s = 5.0;     // beyond exposure and readout, until a frame counts as lost
  double reconnect_timeout_s = 15.0;
};

}  // namespace lumitexel
