#include "processing/brdf/lobe_need.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

LafortuneBrdf diffuse_alone(std::span<const Observation* const> samples, const ErrorModel& error,
                            const LafortuneBrdf& with_lobe) {
  LafortuneBrdf matte;
  matte.channels = with_lobe.channels;
  for (int c = 0; c < matte.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    double xr = 0.0, xx = 0.0;
    for (const Observation* sample : samples) {
      const double w = 1.0 / error.variance(predicted_reflectance(with_lobe, c, sample->geometry),
                                            static_cast<double>(sample->variance[channel]));
      xr += w * sample->geometry.cos_i * static_cast<double>(sample->reflectance[channel]);
      xx += w * sample->geometry.cos_i * sample->geometry.cos_i;
    }
    matte.diffuse[channel] = xx > 0.0 ? std::max(0.0, xr / xx) : 0.0;
  }
  return matte;
}

bool lobe_is_needed(std::span<const Observation* const> samples, const ErrorModel& error, const LafortuneBrdf& with_lobe,
                    const LafortuneBrdf& matte, int parameters) {
  double cost_with = 0.0, cost_without = 0.0;
  for (const Observation* sample : samples) {
    for (int c = 0; c < with_lobe.channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double measured = static_cast<double>(sample->reflectance[channel]);
      const double glossy = predicted_reflectance(with_lobe, c, sample->geometry);
      const double diffuse = predicted_reflectance(matte, c, sample->geometry);
      const double weight = 1.0 / error.variance(glossy, static_cast<double>(sample->variance[channel]));
      cost_with += weight * (glossy - measured) * (glossy - measured);
      cost_without += weight * (diffuse - measured) * (diffuse - measured);
    }
  }
  const auto count = static_cast<double>(samples.size());
  return cost_with > 0.0 ? count * std::log(cost_without / cost_with) > parameters * std::log(count) : cost_without > 0.0;
}

}  // namespace lumitexel
