// Which light each imported photograph was taken under.
//
//   image,type,x,y,z,intensity_r,intensity_g,intensity_b[,split]
//   type   point: position in metres, intensity in W/sr or any one scale
//          directional: unit vector towards the light (up to 1 % off, made unit), irradiance at normal incidence
//   split  fit (also when the column is missing) | heldout
//
// The columns may stand in any order. Lines that are blank or begin with # are skipped.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct LightRow {
  std::string image;
  Light light;  // three intensities, each > 0
  bool heldout = false;
  std::string place;  // "FILE:LINE", for errors found later
};

// Throws BadInput naming `where`, line and column for unknown, repeated or missing columns, and for anything unreadable
// in a row.
std::vector<LightRow> parse_lights_csv(std::string_view text, const std::string& where);

}  // namespace lumitexel
