// Which known material a fitted BRDF comes nearest to.
//
// The distance is the root of the mean squared difference of cube roots of f cos_i, over channels and over the directions of
// one fixed quadrature: the half vector 0 to 80 degrees from the normal, the difference angle 0 to 80 degrees, both directions above the
// surface. Cube roots keep a highlight from deciding alone (Fores, Ferwerda, Gu 2012). 0 for equal BRDFs; a difference of
// 0.05 is about where spheres begin to look different.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "processing/brdf/brdf.h"

namespace lumitexel {

// A BRDF of any form, 1/sr per channel; 0 below the surface.
using BrdfValues = std::function<ChannelValues(const LobeGeometry&)>;

struct KnownMaterial {
  std::string name;
  BrdfValues values;
};

double material_distance(const BrdfValues& a, const BrdfValues& b, int channels);

struct NearMaterial {
  std::size_t index = 0;  // in the list of known ones
  double distance = 0;
};
// All of `known`, nearest first; equal distances keep their order.
std::vector<NearMaterial> nearest_materials(const Brdf& brdf, std::span<const KnownMaterial> known);

}  // namespace lumitexel
