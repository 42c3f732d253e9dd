// From photographs to lumitexels (section 5 of the paper): one lumitexel per pixel of each triangle's best view (or per
// texel, where the atlas says so), and in it one reflectance sample from every view that sees the point lit.
#pragma once

#include "processing/surface/atlas.h"
#include "processing/surface/lumitexel.h"
#include "processing/surface/ray_scene.h"
#include "rig/progress.h"

namespace lumitexel {

// Beyond this angle to the normal a sample says more about the mesh's error than about the surface: a pixel covers four
// times its area, and 1/cos amplifies an error of the normal fourfold.
inline constexpr double kGrazingCosine = 0.25;  // 75.5 degrees

struct GatheredLumitexels {
  LumitexelSet set;  // in order of atlas texel
  RejectionCounts rejected;
  std::vector<std::size_t> used_views;               // indices into session.views
  std::vector<std::vector<SampleVerdict>> verdict;   // by used view, then by lumitexel in the set's order
};

// Reads the fit views' photographs one at a time; held-out views take no part. A sample is
// r = radiance / irradiance, so r = f * cos_i when the light's intensity is on the gray card's scale.
// Throws Corrupt or Error if a photograph cannot be read or has another size than its camera.
GatheredLumitexels gather_lumitexels(const CalibratedSession& session, const Atlas& atlas, const RayScene& scene,
                                     Progress& progress);

}  // namespace lumitexel
