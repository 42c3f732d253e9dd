// A bench of six spheres, an arm and four lights, without pictures: what calibration makes of its highlights' places.
#pragma once

#include "processing/calibration/session_lights.h"
#include "tests/unit/light/light_bound.h"

namespace lumitexel {

struct LightBench {
  RigDescription rig;
  CapturePlan plan;
  std::vector<ViewFrames> views;
  SphereRig spheres;
};

// Camera at the rig's origin, or beside it by `offset`; an arm about a point a metre before it, four of whose lights the spheres see.
LightBench bench_at(const Eigen::Vector3d& offset);

// By highlights good to 0.005 px.
SessionLights lights_of(const LightBench& bench, std::uint64_t seed);

}  // namespace lumitexel
