// One exposure that a plan wants, as data: what to move, what to light, what to expose.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/camera.h"

namespace lumitexel {

enum class ShotKind {
  Silhouette,    // backlight only
  SpheresRing,   // ring flash only: its highlight on a sphere points at the sphere's centre
  SpheresPoint,  // point light, exposed for its highlights on the spheres
  Object,        // point light, one exposure of the view's bracket
  GrayCard,      // point light, one exposure of the card's bracket
  Dark,          // nothing lit
  Board,         // ring flash, the board before the camera
  FlatField,     // none of our lamps: an evenly lit diffuser before the lens
  LampPattern,   // point light on the board in placement 1, one exposure of its bracket
};

const char* to_string(ShotKind kind);                     // "silhouette", "spheres_ring", …
ShotKind shot_kind_from_string(const std::string& name);  // throws Corrupt on any other name

struct Shot {
  std::int64_t id = 0;    // 1, 2, … in the order of shooting
  ShotKind kind = ShotKind::Object;
  std::string view;       // the view's name; empty for kinds that belong to none
  int index = 0;          // within kind and view: place in the bracket; of darks and flat fields the repetition at this
                          // exposure; of boards the placement: 1, 2, …
  CameraSettings camera;  // already quantised to what the camera can do
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
};

// The file inside frames/ that holds the shot's frame: "000017_object.pgm".
std::string frame_file_name(const Shot& shot);

}  // namespace lumitexel
