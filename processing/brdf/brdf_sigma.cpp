#include "processing/brdf/brdf_sigma.h"

#include <cmath>
#include <limits>

#include "processing/brdf/brdf_parameters.h"

namespace lumitexel {

BrdfSigma sigma_of(const Eigen::MatrixXd& covariance, const BrdfParameters& parameters) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const auto sigma = [&](int parameter) {
    const double variance = covariance(parameter, parameter);
    return variance > 0.0 && std::isfinite(variance) ? std::sqrt(variance) : kUnknown;
  };
  BrdfSigma result;
  result.lobes.resize(static_cast<std::size_t>(parameters.lobes()));
  for (int c = 0; c < parameters.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    result.diffuse[channel] = sigma(parameters.diffuse(c));
    for (int lobe = 0; lobe < parameters.lobes(); ++lobe) {
      const double aim = parameters.family().aims ? sigma(parameters.aim(lobe, c)) : kUnknown;
      result.lobes[static_cast<std::size_t>(lobe)][channel] = {sigma(parameters.log_strength(lobe, c)), sigma(parameters.log_shape(lobe, c)), aim};
    }
  }
  return result;
}

}  // namespace lumitexel
