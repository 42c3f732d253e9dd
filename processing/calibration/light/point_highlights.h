// The point light's highlights on the spheres, told apart from those of other lights.
//
// Where a sphere shows one highlight, that is the light's. Where spheres show several (a second lamp, the lamp's image in a
// window or a polished stand), assign_highlights sorts them over the spheres; the rig's own light is the one nearest to
// where the rig's description has it, and what no light explains is taken for the own one only where the description
// expects it. Where two lights' highlights are so near to one another that their skirts run together, they are left out.
#pragma once

#include <functional>
#include <vector>

#include "processing/calibration/light/highlight_shots.h"
#include "processing/calibration/light/sphere_line.h"

namespace lumitexel {

struct PointHighlights {
  std::vector<std::vector<HighlightPixel>> own;                   // by view
  std::vector<SeenInView> seen;                                   // the same as they were found and fitted, those without a fit too
  std::vector<std::vector<std::vector<HighlightPixel>>> strays;  // by view, then a light each, fitted as points; the own one is not among them
};

// What the rig's description says of the light, in the camera's frame.
struct ExpectedLights {
  std::vector<Eigen::Vector3d> positions;  // by view
  double reach_m = 0;                      // how far off they may be
  EmitterDisc lamp;
};

// The highlight on a sphere of a lamp at `light`: of one of some size, so many equal peaks about its reflection's centroid. `light` may be
// off by a part of its distance: where they lie about the centroid hardly changes.
HighlightShape lamp_shape(const SphereInView& view, const Eigen::Vector3d& light, const EmitterDisc& lamp);

struct SortedHighlights {
  SeenInView own;
  std::vector<SeenInView> strays;
};

// One view's fitted highlights. expected: the own light by the rig's description, in the camera's frame; reach_m: how far off it may be.
SortedHighlights sort_highlights(const CameraModel& camera, const SphereLine& line, const SeenInView& seen,
                                 const Eigen::Vector3d& expected, double reach_m);

// step: called once a shot.
PointHighlights read_point_highlights(const PictureOf& picture, const CameraModel& camera,
                                      const SphereLine& line, const ExpectedLights& expected,
                                      const std::function<void()>& step);

}  // namespace lumitexel
