// A BRDF as the fits make it: diffuse light and up to a few isotropic lobes of one family.
//
//   f(wi, wo) = kd + sum over lobes (strength * gain(shape, aim; wi, wo) + offset(shape, aim; wi, wo))      1/sr, without the cosine
//
// What strength, shape and aim mean is the family's (lobe_family.h); gain and offset do not depend on the strength, so for
// given shapes a BRDF is linear in kd and the strengths.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "processing/brdf/lobe_geometry.h"

namespace lumitexel {

inline constexpr int kMaxChannels = 3;
inline constexpr double kMirrorAim = 0.7853981633974483;  // pi / 4

enum class BrdfFamily { Lafortune, Ggx, Ward };

struct Lobe {
  double log_strength = -std::numeric_limits<double>::infinity();  // minus infinity switches the lobe off
  double log_shape = 2;
  double aim = kMirrorAim;  // only families that aim look at it

  bool same_shape(const Lobe& other) const { return log_shape == other.log_shape && aim == other.aim; }
};

struct Brdf {
  BrdfFamily family = BrdfFamily::Lafortune;
  int channels = 3;
  std::array<double, kMaxChannels> diffuse{};         // kd per channel, 1/sr, >= 0
  std::vector<std::array<Lobe, kMaxChannels>> lobes;  // each with one entry per channel
};

const char* to_string(BrdfFamily family);                   // "lafortune", "ggx", "ward"
BrdfFamily brdf_family_from_string(const std::string& name);  // throws BadInput

// f in channel c, 1/sr; 0 if either direction is below the surface.
double evaluate(const Brdf& brdf, int c, const LobeGeometry& geometry);

// The same for all channels at once; shapes that channels share are worked out once.
using ChannelValues = std::array<double, kMaxChannels>;
ChannelValues evaluate(const Brdf& brdf, const LobeGeometry& geometry);

}  // namespace lumitexel
