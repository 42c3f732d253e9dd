// Figures of one or two frames of sensor integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rig/commission/commission_report.h"

namespace lumitexel {

using Samples = std::span<const std::uint16_t>;

inline constexpr double kQuantisation_dn2 = 1.0 / 12.0;  // the variance that rounding to integers adds

double mean_of(Samples samples);
// The value below which `share` (0 to 1) of the samples lie.
double quantile_of(Samples samples, double share);

// Two frames of the same still scene, `black` subtracted: pixels grouped by their mean signal, per group the noise of one
// frame, as half the mean square of the difference. Pixels above `highest` are left out: clipping narrows their noise.
struct NoiseGroup {
  double mean_dn = 0, variance_dn2 = 0, sigma_dn2 = 0;  // sigma: of the variance
  std::size_t pixels = 0;
};
std::vector<NoiseGroup> noise_groups(Samples first, Samples second, double black_dn, double highest_dn, int groups);

// variance = read_variance + mean / electrons_per_dn, weighted by each group's sigma (EMVA 1288's photon-transfer
// method). Throws Error with fewer than three groups or without a rise.
struct PhotonTransfer {
  Measured electrons_per_dn;
  double read_variance_dn2 = 0;
};
PhotonTransfer fit_photon_transfer(const std::vector<NoiseGroup>& groups);

// y = offset + slope x by least squares, with the slope's standard error from the residuals.
struct Line {
  double offset = 0;
  Measured slope;
  double residual_sigma = 0;
};
Line fit_line(const std::vector<CurvePoint>& points);

double median_of(std::vector<double> values);   // NaN if empty
double deviation_of(const std::vector<double>& values);  // standard deviation, n - 1; 0 for fewer than two

}  // namespace lumitexel
