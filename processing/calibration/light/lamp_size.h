// The lamp's radius, from how much wider its highlights on the spheres are than the ring flash's.
//
// On one sphere a point's highlight has one width, whoever's light it is: the sphere's roughness and the lens make it. The ring
// flash, fitted as points at known places, tells that width w_k of sphere k and the profile's exponent b; with b held, the lamp is
// fitted as a disc of radius r, and
//   g(r) = mean over spheres of log(width_k(r)^2 / w_k^2)
// falls as r^2 grows; the lamp's radius is where it is zero. Widths count across the plane of camera, sphere and lamp alone: along
// it the lens's blur, not the roughness, is stretched by the sphere's slope. A lamp whose g(0) is below three sigmas is a point, as
// far as can be told. The sigma: scatter of the spheres (by bounds with Student's t for so few), the profile's error (1 %), and the ring flash's radius, which the rig's file is
// taken to know to 0.5 %; of a radius also 2 %, more where the disc is wider than a point's highlight.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/light/point_highlights.h"
#include "processing/calibration/light/point_widths.h"

namespace lumitexel {

struct LampSize {
  bool measured = false;  // false: fewer than three spheres have widths of both, and the rest means nothing
  bool resolved = false;  // false: a point, as far as can be told
  bool found = false;     // of a resolved one: false where the search ended at the largest lamp or before it was near
  double radius_m = 0;    // 0 where not resolved
  double sigma_m = 0;     // of radius_m; 0 where not resolved; where not found at least what it may still be off by, up to the largest lamp
  double upper_m = 0;     // 95 % bound where not resolved
};

struct LampHighlights {
  std::vector<SeenInView> seen;                         // by view: the lamp's, fitted
  std::vector<std::optional<Eigen::Vector3d>> lights;   // by view: where it stood, camera's frame; none: not known, not used
  Eigen::Vector3d faces = Eigen::Vector3d::Zero();      // EmitterDisc's
  double most_m = 0.2;                                  // no lamp is larger
};
LampSize measure_lamp_size(const PointWidths& widths, const PictureOf& point, const CameraModel& camera, const SphereLine& line,
                           const LampHighlights& lamp);

}  // namespace lumitexel
