#include "processing/calibration/lens/checkerboard_corners.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/calibration/lens/patch_fit.h"

namespace lumitexel {
namespace {

enum : Eigen::Index { kX, kY, kAngle1, kAngle2, kBlurVariance, kMean, kContrast, kFalloffX, kFalloffY, kParameters };

// One of the two edges as a pixel sees it, from -1 on its one side to 1 on the other.
struct Side {
  double value, slope, turn, by_blur;  // its derivatives by the distance, by the edge's angle, by the blur's variance
  Eigen::Vector2d outward;
};

// No lens is sharper; and an unblurred edge between two pixels would not tell where between them it is.
constexpr double kLeastBlur_px = 0.2;

// A Gaussian step averaged over the pixel: seen along the edge's normal, a pixel is the convolution of two boxes. The wider
// one is averaged over exactly, which an edge along the rows of an unblurred picture needs; the narrower one widens the Gaussian.
Side side_of(double angle, double blur_variance_px2, const Eigen::Vector2d& offset) {
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), outward(-along.y(), along.x());
  const Eigen::Index wide = std::abs(outward.x()) >= std::abs(outward.y()) ? 0 : 1, narrow = 1 - wide;
  const double half = 0.5 * std::abs(outward[wide]), other = 0.5 * std::abs(outward[narrow]);
  const double own = std::max(blur_variance_px2, kLeastBlur_px * kLeastBlur_px);
  const double b = std::sqrt(own + other * other / 3.0);
  const double distance = outward.dot(offset), high = (distance + half) / b, low = (distance - half) / b;
  const double step_high = 2.0 * normal_integral(high) - 1.0, step_low = 2.0 * normal_integral(low) - 1.0;
  const double bump_high = 2.0 * normal_density(high), bump_low = 2.0 * normal_density(low);
  const double value = b * (high * step_high + bump_high - low * step_low - bump_low) / (2.0 * half);
  const double slope = (step_high - step_low) / (2.0 * half);
  const double by_b = (bump_high - bump_low) / (2.0 * half), by_half = (0.5 * (step_high + step_low) - value) / half;
  // The boxes change as the edge turns: d outward / d angle = -along.
  const double half_turn = -0.5 * std::copysign(along[wide], outward[wide] * along[wide]);
  const double other_turn = -0.5 * std::copysign(along[narrow], outward[narrow] * along[narrow]);
  const double turn = -along.dot(offset) * slope + by_half * half_turn + by_b * other / (3.0 * b) * other_turn;
  const bool free = blur_variance_px2 > kLeastBlur_px * kLeastBlur_px;
  return {value, slope, turn, free ? 0.5 * by_b / b : 0.0, outward};
}

// A sample of this part holds the blur's variance at the sample's value.
enum : int { kOfPicture = 0, kOfBlur = 1 };

double crossing_profile(const PatchSample& sample, const Eigen::VectorXd& p, Eigen::VectorXd& gradient) {
  if (sample.part == kOfBlur) {
    gradient.setZero();
    gradient[kBlurVariance] = 1.0;
    return p[kBlurVariance];
  }
  const Eigen::Vector2d offset = sample.pixel - p.head<2>();
  const double blur_px2 = p[kBlurVariance];
  const Side one = side_of(p[kAngle1], blur_px2, offset), two = side_of(p[kAngle2], blur_px2, offset);
  const double light = 1.0 + p[kFalloffX] * offset.x() + p[kFalloffY] * offset.y();
  const double pattern = p[kMean] + p[kContrast] * one.value * two.value, gain = light * p[kContrast];
  const Eigen::Vector2d by_offset = gain * (one.slope * two.value * one.outward + two.slope * one.value * two.outward) +
                                    pattern * p.segment<2>(kFalloffX);
  gradient.head<2>() = -by_offset;
  gradient[kAngle1] = gain * one.turn * two.value;
  gradient[kAngle2] = gain * two.turn * one.value;
  gradient[kBlurVariance] = gain * (one.by_blur * two.value + two.by_blur * one.value);
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
  p[kAngle1] = angle1, p[kAngle2] = angle2, p[kBlurVariance] = 0.36;
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

// The blur free; or, where the picture has less of it than can be told, at its least.
std::optional<PatchFit> fit_crossing(std::vector<PatchSample> samples, Eigen::VectorXd start,
                                     const Eigen::Vector2d& centre) {
  constexpr double kLeastBlur_px2 = kLeastBlur_px * kLeastBlur_px, kHeld_px2 = 1e-3;
  auto fit = fit_patch(samples, start, crossing_profile);
  if (fit && fit->parameters[kBlurVariance] > kLeastBlur_px2) return fit;
  start[kBlurVariance] = kLeastBlur_px2;
  samples.push_back({centre, kLeastBlur_px2, samples[0].sigma > 0 ? kHeld_px2 : 0.0, kOfBlur});
  return fit_patch(samples, start, crossing_profile);
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
    const Eigen::VectorXd first = crossing_start(samples, centre, angle1, angle2);
    fit = fit_crossing(std::move(samples), first, centre);
    constexpr double kMostMove_px = 3.0;
    if (!fit || (fit->parameters.head<2>() - start).norm() > kMostMove_px) return std::nullopt;
    centre = fit->parameters.head<2>();
  }
  if (!(fit->parameters[kBlurVariance] < 0.25 * reach * reach)) return std::nullopt;
  return CheckerCorner{centre, fit->covariance.topLeftCorner<2, 2>(), fit->reduced_chi2};
}

}  // namespace lumitexel
