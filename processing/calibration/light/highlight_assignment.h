// Which highlight belongs to which light, when several lights are on at once and nobody says which is which.
//
// Two highlights on two spheres of the line give two mirrored rays; where they meet, a light may be. A light there has its
// highlight on every other sphere in a place that is then known, so true pairs find company and false ones do not. The
// candidate with the most company (the least misfit among equals) is a light; its highlights are taken out, and the search
// starts again.
#pragma once

#include <vector>

#include "processing/calibration/light/light_position.h"

namespace lumitexel {

struct AssignedLight {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // a start for solve_lights, camera's frame
  std::vector<HighlightPixel> highlights;              // at most one a sphere
};

struct HighlightAssignment {
  std::vector<AssignedLight> lights;      // those with most highlights first
  std::vector<HighlightPixel> left_over;  // of no light
};

// seen: any number of highlights a sphere, in any order. A light needs `least` highlights (3 or more; with 3 of 6 spheres
// chance finds one now and then, with 4 hardly) within tolerance_px of where it should have them. Throws BadInput if least
// is below 3, the tolerance is not positive, or a highlight names a sphere that the line has not.
HighlightAssignment assign_highlights(const CameraModel& camera, const SphereLine& line,
                                      const std::vector<HighlightPixel>& seen, int least = 4, double tolerance_px = 1.0);

}  // namespace lumitexel
