#include "processing/brdf/brdf.h"

#include <cmath>

#include "drivers/error.h"
#include "processing/brdf/lobe_family.h"

namespace lumitexel {
namespace {

constexpr BrdfFamily kFamilies[] = {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward};

bool is_off(const Lobe& lobe) { return lobe.log_strength == -std::numeric_limits<double>::infinity(); }

}  // namespace

const char* to_string(BrdfFamily family) { return lobe_family(family).name; }

BrdfFamily brdf_family_from_string(const std::string& name) {
  for (const BrdfFamily family : kFamilies) {
    if (name == to_string(family)) return family;
  }
  throw BadInput("family", "'" + name + "'", "lafortune, ggx or ward");
}

double evaluate(const Brdf& brdf, int c, const LobeGeometry& geometry) {
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return 0.0;
  const auto channel = static_cast<std::size_t>(c);
  const LobeFamily& family = lobe_family(brdf.family);
  double value = brdf.diffuse[channel];
  for (const auto& lobe : brdf.lobes) {
    if (is_off(lobe[channel])) continue;
    const LobeTerms terms = family.terms(lobe[channel].log_shape, lobe[channel].aim, geometry);
    value += std::exp(lobe[channel].log_strength) * terms.gain + terms.offset;
  }
  return value;
}

ChannelValues evaluate(const Brdf& brdf, const LobeGeometry& geometry) {
  ChannelValues values{};
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return values;
  const LobeFamily& family = lobe_family(brdf.family);
  const auto channels = static_cast<std::size_t>(brdf.channels);
  values = brdf.diffuse;
  for (const auto& lobe : brdf.lobes) {
    LobeTerms terms;
    for (std::size_t c = 0; c < channels; ++c) {
      if (c == 0 || !lobe[c].same_shape(lobe[c - 1])) terms = family.terms(lobe[c].log_shape, lobe[c].aim, geometry);
      if (!is_off(lobe[c])) values[c] += std::exp(lobe[c].log_strength) * terms.gain + terms.offset;
    }
  }
  return values;
}

}  // namespace lumitexel
