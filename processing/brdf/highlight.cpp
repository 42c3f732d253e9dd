#include "processing/brdf/highlight.h"

#include <algorithm>

namespace lumitexel {
namespace {

constexpr double kGlossyRatio = 2.0, kNearHighlight = 0.1;

double mean(const ChannelValues& f, int channels) {
  double sum = 0.0;
  for (int c = 0; c < channels; ++c) sum += f[static_cast<std::size_t>(c)];
  return sum / channels;
}

double specular(const Brdf& brdf, const LobeGeometry& geometry) {
  return mean(evaluate(brdf, geometry), brdf.channels) - mean(brdf.diffuse, brdf.channels);
}

}  // namespace

bool has_highlight(const Brdf& brdf) {
  return mean(evaluate(brdf, kGlossGeometry), brdf.channels) >= kGlossyRatio * mean(brdf.diffuse, brdf.channels);
}

bool near_highlight(const Brdf& brdf, const LobeGeometry& geometry) {
  const double cos_i = geometry.cos_i;
  if (!(cos_i > 0.0)) return false;
  return specular(brdf, geometry) >= kNearHighlight * specular(brdf, geometry_of_cosines(2.0 * cos_i * cos_i - 1.0, cos_i, cos_i));
}

}  // namespace lumitexel
