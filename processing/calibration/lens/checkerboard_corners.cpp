#include "processing/calibration/lens/checkerboard_corners.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/calibration/lens/patch_fit.h"

namespace lumitexel {
namespace {

enum : Eigen::Index { kX, kY, kAngle1, kAngle2, kBlur, kMean, kContrast, kFalloffX, kFalloffY, kParameters };

struct Side {
  double value, slope, turn;  // erf, its derivative by distance and by the edge's angle
  Eigen::Vector2d outward;
};

Side side_of(double angle, double blur, const Eigen::Vector2d& offset) {
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), outward(-along.y(), along.x());
  const double distance = outward.dot(offset), slope = 2.0 * normal_density(distance / blur) / blur;
  return {2.0 * normal_integral(distance / blur) - 1.0, slope, -along.dot(offset) * slope, outward};
}

double crossing_profile(const PatchSample& sample, const Eigen::VectorXd& p, Eigen::VectorXd& gradient) {
  const Eigen::Vector2d offset = sample.pixel - p.head<2>();
  const double blur = p[kBlur];
  const Side one = side_of(p[kAngle1], blur, offset), two = side_of(p[kAngle2], blur, offset);
  const double light = 1.0 + p[kFalloffX] * offset.x() + p[kFalloffY] * offset.y();
  const double pattern = p[kMean] + p[kContrast] * one.value * two.value, gain = light * p[kContrast];
  const Eigen::Vector2d by_offset = gain * (one.slope * two.value * one.outward + two.slope * one.value * two.outward) +
                                    pattern * p.segment<2>(kFalloffX);
  gradient.head<2>() = -by_offset;
  gradient[kAngle1] = gain * one.turn * two.value;
  gradient[kAngle2] = gain * two.turn * one.value;
  gradient[kBlur] = -gain / blur *
                    (one.slope * one.outward.dot(offset) * two.value + two.slope * two.outward.dot(offset) * one.value);
  gradient[kMean] = light;
  gradient[kContrast] = light * one.value * two.value;
  gradient[kFalloffX] = pattern * offset.x();
  gradient[kFalloffY] = pattern * offset.y();
  return light * pattern;
}

Eigen::VectorXd crossing_start(const std::vector<PatchSample>& samples, const Eigen::Vector2d& start, double angle1,
                               double angle2) {
  Eigen::VectorXd p = Eigen::VectorXd::Zero(kParameters);
  p.head<2>() = start;
  p[kAngle1] = angle1, p[kAngle2] = angle2, p[kBlur] = 0.8;
  double same = 0, other = 0, count_same = 0, count_other = 0;
  for (const PatchSample& sample : samples) {
    const Eigen::Vector2d offset = sample.pixel - start;
    const bool equal = (side_of(angle1, 1.0, offset).value > 0) == (side_of(angle2, 1.0, offset).value > 0);
    (equal ? same : other) += sample.value;
    (equal ? count_same : count_other) += 1.0;
  }
  same /= std::max(1.0, count_same), other /= std::max(1.0, count_other);
  p[kMean] = 0.5 * (same + other);
  p[kContrast] = 0.5 * (same - other);
  return p;
}

}  // namespace

std::optional<CheckerCorner> measure_checker_corner(const MosaicRadiance& image, const Eigen::Vector2d& start,
                                                    const Eigen::Vector2d& along_columns,
                                                    const Eigen::Vector2d& along_rows) {
  // Reaches less than half a square, so that nothing of the next edges is seen through the blur.
  constexpr double kWidest_px = 8.0, kBlurAllowance_px = 1.5;
  const double crossing = std::abs(along_columns.x() * along_rows.y() - along_columns.y() * along_rows.x());
  const double narrowest = crossing / std::max(along_columns.norm(), along_rows.norm());  // of the parallelogram
  const double reach = std::min(kWidest_px, 0.7 * narrowest - kBlurAllowance_px);
  if (!(reach >= 2.0)) return std::nullopt;
  Eigen::Vector2d centre = start;
  std::optional<PatchFit> fit;
  for (int round = 0; round < 2; ++round) {  // the patch follows the corner
    const Eigen::Vector2d extent(reach, reach);
    if ((centre - extent).minCoeff() < 0 || centre.x() + reach > image.width || centre.y() + reach > image.height)
      return std::nullopt;
    std::vector<PatchSample> samples = patch_samples(image, centre - extent, centre + extent);
    std::erase_if(samples, [&](const PatchSample& s) { return (s.pixel - centre).norm() > reach; });
    const double angle1 = std::atan2(along_columns.y(), along_columns.x());
    const double angle2 = std::atan2(along_rows.y(), along_rows.x());
    const double least_samples = 0.3 * std::numbers::pi * reach * reach;  // green is half of a mosaic
    if (static_cast<double>(samples.size()) < std::max(12.0, least_samples)) return std::nullopt;
    fit = fit_patch(samples, crossing_start(samples, centre, angle1, angle2), crossing_profile);
    constexpr double kMostMove_px = 3.0;
    if (!fit || (fit->parameters.head<2>() - start).norm() > kMostMove_px) return std::nullopt;
    centre = fit->parameters.head<2>();
  }
  if (!(fit->parameters[kBlur] > 0.05) || fit->parameters[kBlur] > 0.5 * reach) return std::nullopt;
  return CheckerCorner{centre, fit->covariance.topLeftCorner<2, 2>(), fit->reduced_chi2};
}

}  // namespace lumitexel
