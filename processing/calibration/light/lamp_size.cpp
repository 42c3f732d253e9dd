#include "processing/calibration/light/lamp_size.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/calibration/light/median.h"
#include "processing/calibration/light/student_bound.h"

namespace lumitexel {
namespace {

constexpr double kLeastSigmas = 3.0;
constexpr double kProfileError = 0.01;  // of log width^2: a lamp's highlights lie elsewhere on the spheres than the ring's
constexpr double kRingError = 0.005;  // of the ring flash's radius
// Of a radius: twelve peaks stand for a disc, the worse the larger it is over the point's width (disc_part). Rendered discs are off by
// 1 % where it is 0.5, by 4 % where it is 2, with blur by 2 and 3.
constexpr double kModelError = 0.02, kModelErrorOfPart = 1.5;
constexpr double kOneInTwenty = 1.645;
constexpr int kLeastSpheres = 3;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Unit vector of t's plane across the plane of camera, sphere and highlight; along x where the highlight faces the camera.
Eigen::Vector2d across_slope(const SphereInView& view, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction = view.camera.unproject(pixel);
  const auto mirrored = mirrored_ray(view.sphere, {Eigen::Vector3d::Zero(), direction});
  if (!mirrored) return Eigen::Vector2d::UnitX();
  const Eigen::Vector3d normal = (mirrored->origin - view.sphere.centre).normalized();
  const Eigen::Vector3d across = normal.cross(direction);
  const auto t = across_centre(view, pixel, across);
  constexpr double kNoSlope = 1e-6;
  return t && across.norm() > kNoSlope ? t->normalized() : Eigen::Vector2d(Eigen::Vector2d::UnitX());
}

double square_along(const Eigen::Vector2d& u, const FittedHighlight& fit) { return u.dot(fit.spread_px2 * u); }

struct SphereMean {
  double mean = 0, sigma = 0;
  int spheres = 0;
};

// Of values that come with their sphere; those far off the median are something else's.
SphereMean mean_of_spheres(const std::vector<std::pair<int, double>>& values, int spheres) {
  SphereMean result;
  if (values.empty()) return result;
  std::vector<double> all, off;
  for (const auto& value : values) all.push_back(value.second);
  const double middle = median(all);
  for (const double value : all) off.push_back(std::abs(value - middle));
  constexpr double kFarOff = 5.0 * 1.4826, kLeastReach = 0.02;
  const double reach = std::max(kLeastReach, kFarOff * median(off));
  std::vector<double> means;
  for (int k = 0; k < spheres; ++k) {
    double sum = 0.0;
    int count = 0;
    for (const auto& [sphere, value] : values) {
      if (sphere != k || std::abs(value - middle) > reach) continue;
      sum += value;
      ++count;
    }
    if (count > 0) means.push_back(sum / count);
  }
  result.spheres = static_cast<int>(means.size());
  for (const double mean : means) result.mean += mean / result.spheres;
  double square = 0.0;
  for (const double mean : means) square += (mean - result.mean) * (mean - result.mean);
  result.sigma = result.spheres > 1 ? std::sqrt(square / (result.spheres - 1) / result.spheres) : 0.0;
  return result;
}

class Sizing {
 public:
  Sizing(const PointWidths& widths, const PictureOf& point, const CameraModel& camera, const SphereLine& line, const LampHighlights& lamp)
      : widths_(widths), camera_(camera), line_(line), lamp_(lamp) {
    views_ = spread_views(lamp.seen.size(), [&](std::size_t v) { return lamp.lights[v].has_value() && !lamp.seen[v].empty(); });
    for (const std::size_t v : views_) pictures_.push_back(point(v));
  }

  // g at the radius.
  SphereMean excess(double radius_m) const {
    std::vector<std::vector<std::pair<int, double>>> by_view(views_.size());
    tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
      for (const SeenHighlight& highlight : lamp_.seen[views_[i]]) {
        const double value = log_ratio(i, highlight, radius_m);
        if (std::isfinite(value)) by_view[i].emplace_back(highlight.sphere, value);
      }
    });
    std::vector<std::pair<int, double>> all;
    for (const auto& view : by_view) all.insert(all.end(), view.begin(), view.end());
    return mean_of_spheres(all, line_.count);
  }

  // Mean over the highlights of the disc's mean square offset across at the radius, over the point's width squared.
  double disc_part(double radius_m) const {
    double sum = 0.0;
    int count = 0;
    for (const std::size_t v : views_) {
      for (const SeenHighlight& highlight : lamp_.seen[v]) {
        const SphereInView view = view_of(highlight);
        const double part = mean_square_along(across_slope(view, highlight.blob.pixel), shape_of(v, highlight, radius_m).peaks) /
                            std::exp(width_of(highlight));
        if (!std::isfinite(part)) continue;
        sum += part;
        ++count;
      }
    }
    return count > 0 ? sum / count : 0.0;
  }

  // By how much log width^2 falls for a small disc, over its disc_part: the profile's, found on one highlight a view.
  double fall_per_part(double radius_m) const {
    double fall = 0.0, part = 0.0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      for (const SeenHighlight& highlight : lamp_.seen[views_[i]]) {
        const double change = log_ratio(i, highlight, 0.0) - log_ratio(i, highlight, radius_m);
        if (!std::isfinite(change)) continue;
        fall += change;
        part += mean_square_along(across_slope(view_of(highlight), highlight.blob.pixel), shape_of(views_[i], highlight, radius_m).peaks) /
                std::exp(width_of(highlight));
        break;
      }
    }
    return part > 0.0 ? fall / part : 0.0;
  }

 private:
  SphereInView view_of(const SeenHighlight& highlight) const { return {camera_, line_.sphere(highlight.sphere)}; }
  double width_of(const SeenHighlight& highlight) const { return widths_.log_square[static_cast<std::size_t>(highlight.sphere)]; }

  HighlightShape shape_of(std::size_t v, const SeenHighlight& highlight, double radius_m) const {
    HighlightShape shape = lamp_shape(view_of(highlight), *lamp_.lights[v], {radius_m, lamp_.faces});
    shape.others_px = highlight.others_px;
    shape.exponent = widths_.exponent;
    return shape;
  }

  // NaN where something is not known.
  double log_ratio(std::size_t i, const SeenHighlight& highlight, double radius_m) const {
    const double point = width_of(highlight);
    if (!std::isfinite(point)) return kNone;
    const std::optional<ColourBalance> balance = highlight.fit ? std::optional(highlight.fit->balance) : std::nullopt;
    const auto fit = fit_highlight(pictures_[i], highlight.blob.pixel, kHighlightReach_px, balance, shape_of(views_[i], highlight, radius_m));
    return fit ? std::log(square_along(across_slope(view_of(highlight), fit->pixel), *fit)) - point : kNone;
  }

  const PointWidths& widths_;
  const CameraModel& camera_;
  const SphereLine& line_;
  const LampHighlights& lamp_;
  std::vector<std::size_t> views_;
  std::vector<MosaicRadiance> pictures_;
};

// Where g is zero, by secants of exp(g) - 1, which is nearly straight in r^2, kept inside a shrinking bracket: a disc much too large
// leaves no width at all, and no slope.
LampSize resolved_size(const Sizing& sizing, const SphereMean& at_zero, double slope, double most2,
                       const std::function<double(const SphereMean&)>& sigma_of) {
  struct Point {
    double square, value;
  };
  Point low{0.0, std::expm1(at_zero.mean)}, high{most2, -1.0};
  double square = std::min(0.5 * most2, 0.5 * at_zero.mean / slope), down = slope, sigma = sigma_of(at_zero);
  constexpr int kSteps = 8;
  constexpr double kNearEnough = 0.3;  // of a sigma; the last secant comes much nearer
  constexpr double kLeastShare = 0.1;  // of the bracket, from either end
  constexpr double kLongestStride = 1.7;
  bool near = false;
  for (int step = 0; step < kSteps && !near; ++step) {
    const SphereMean here = sizing.excess(std::sqrt(square));
    const bool known = here.spheres >= kLeastSpheres;
    const Point point{square, known ? std::expm1(here.mean) : -1.0};
    const double from_low = (low.value - point.value) / (point.square - low.square);
    if (known && from_low > 0.0) {
      down = from_low;
      sigma = sigma_of(here);
    }
    const double next = known && from_low > 0.0 ? square + point.value / from_low : 0.5 * (low.square + square);
    (point.value > 0.0 ? low : high) = point;
    const double margin = high.square < most2 ? kLeastShare * (high.square - low.square) : 0.0;
    near = known && next < most2 && std::abs(next - square) * down < kNearEnough * sigma;
    // From below, in small strides: of a disc much too large the fits make what they like, a second zero too.
    const double most = std::min(high.square - margin, kLongestStride * square);
    square = near ? next : std::clamp(next, std::min(low.square + margin, most), most);
  }
  const double radius_m = std::sqrt(square);
  const double model = kModelError * std::max(1.0, kModelErrorOfPart * sizing.disc_part(radius_m)) * radius_m;
  const double stated = std::hypot(model, sigma / down / (2.0 * radius_m));
  // Where it was not found, it may be anywhere in what is left of the bracket.
  const double left = near ? 0.0 : std::max(radius_m - std::sqrt(low.square), std::sqrt(high.square) - radius_m);
  return {true, true, near, radius_m, std::max(stated, left), 0.0};
}

}  // namespace

LampSize measure_lamp_size(const PointWidths& widths, const PictureOf& point, const CameraModel& camera, const SphereLine& line,
                           const LampHighlights& lamp) {
  const Sizing sizing(widths, point, camera, line, lamp);
  LampSize size;
  const SphereMean at_zero = sizing.excess(0.0);
  if (at_zero.spheres < kLeastSpheres) return size;
  constexpr double kTrialShare = 0.05;  // of the most there may be: a small disc, whose effect goes with its square
  const double trial_m = kTrialShare * lamp.most_m;
  const double fall = sizing.fall_per_part(trial_m), part = sizing.disc_part(trial_m);
  const double slope = fall * part / (trial_m * trial_m);  // of g by r^2, downwards
  if (!(slope > 0.0)) return size;
  size.measured = true;
  const double by_ring = fall * widths.ring_part * 2.0 * kRingError;
  const auto sigma_of = [&](const SphereMean& excess) { return std::hypot(excess.sigma, kProfileError, by_ring); };
  // The scatter is that of so few spheres; the other errors are not.
  const auto bound_of = [&](double z) {
    return std::hypot(student_bound(at_zero.spheres - 1.0, z) * at_zero.sigma, z * kProfileError, z * by_ring);
  };
  if (at_zero.mean < bound_of(kLeastSigmas)) {
    size.upper_m = std::min(lamp.most_m, std::sqrt((std::max(0.0, at_zero.mean) + bound_of(kOneInTwenty)) / slope));
    return size;
  }
  return resolved_size(sizing, at_zero, slope, lamp.most_m * lamp.most_m, sigma_of);
}

}  // namespace lumitexel
