// How to reach a still camera through libgphoto2, and what its settings are called.
#pragma once

#include <map>
#include <string>

namespace lumitexel {

struct GphotoConnection {
  std::string model;          // libgphoto2's name: "PTP/IP Camera", "Canon EOS 5D Mark III"; empty: detected on USB
  std::string port = "usb:";  // "ptpip:192.168.1.7", "usb:001,004"
  std::string exposure_setting = "shutterspeed", gain_setting = "iso";
  // A text setting that the camera copies into each picture's EXIF artist or copyright: the frame then proves by itself
  // which shot it is. libgphoto2 calls it "artist" for the makers that it knows, and "501e", PTP's own number of it,
  // for a camera that speaks plain PTP. Empty: not used.
  std::string frame_name_setting;
  // Set once on connecting, in this order by name: "imagequality" = "RAW", "f-number" = "f/8", …
  std::map<std::string, std::string> fixed_settings;
  double iso_at_0_db = 100.0;      // gain_db = 20 log10(iso / iso_at_0_db)
  double answer_timeout_s = 10.0;  // beyond the exposure, until the picture counts as lost
  double reconnect_timeout_s = 20.0;
};

}  // namespace lumitexel
