#include "processing/image/response_spline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumitexel {
namespace {

// The four cubic B-splines that are not zero at `place` in a cell.
std::array<double, 4> blends(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0, (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
          t * t * t / 6.0};
}

}  // namespace

// Knots equidistant in the square root: response curves bend most near black.
ResponseSpline::Vector ResponseSpline::basis(double u) {
  constexpr int kSpans = kSplines - 3;
  const double at = std::sqrt(std::clamp(u, 0.0, 1.0)) * kSpans;
  const int span = std::min(static_cast<int>(at), kSpans - 1);
  const std::array<double, 4> blend = blends(at - span);
  Vector values = Vector::Zero();
  for (int k = 0; k < 4; ++k) values[span + k] = blend[static_cast<std::size_t>(k)];
  values[kSplines] = std::log(std::clamp(u, 0.0, 1.0) + 0.002);
  return values;
}

// Simpson's rule over cells equidistant in the square root as well: the spline is smooth in it.
ResponseSpline::ResponseSpline(const Vector& c) {
  const auto node = [](double i) { return std::pow(i / kCells, 2); };
  double value = 0.0;
  Vector gradient = Vector::Zero();
  for (int i = 0; i <= kCells; ++i) {
    const Vector here = basis(node(i));
    const double slope = std::exp(here.dot(c));
    values_.push_back(value);
    slopes_.push_back(slope);
    gradients_.push_back(gradient);
    if (i == kCells) break;
    // In the square root s: du = 2 s ds.
    const double ds = 1.0 / kCells, s0 = i * ds, s1 = s0 + 0.5 * ds, s2 = s0 + ds;
    const Vector middle = basis(s1 * s1), next = basis(s2 * s2);
    const double f0 = 2.0 * s0 * slope, f1 = 2.0 * s1 * std::exp(middle.dot(c)), f2 = 2.0 * s2 * std::exp(next.dot(c));
    value += ds / 6.0 * (f0 + 4.0 * f1 + f2);
    gradient += ds / 6.0 * (f0 * here + 4.0 * f1 * middle + f2 * next);
  }
}

double ResponseSpline::linear(double u) const {
  if (u <= 0.0) return u * slopes_.front();
  if (u >= 1.0) return values_.back() + (u - 1.0) * slopes_.back();
  const double at = std::sqrt(u) * kCells;
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kCells - 1));
  const double from = std::pow(static_cast<double>(i) / kCells, 2);
  // The slope changes little within a cell.
  return values_[i] + (u - from) * 0.5 * (slopes_[i] + slope(u));
}

double ResponseSpline::slope(double u) const {
  const double at = std::sqrt(std::clamp(u, 0.0, 1.0)) * kCells;
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kCells - 1));
  const double part = at - static_cast<double>(i);
  return (1.0 - part) * slopes_[i] + part * slopes_[i + 1];
}

double ResponseSpline::inverse(double value) const {
  if (value <= 0.0) return value / slopes_.front();
  if (value >= values_.back()) return 1.0 + (value - values_.back()) / slopes_.back();
  const auto above = std::upper_bound(values_.begin(), values_.end(), value);
  const auto i = static_cast<std::size_t>(above - values_.begin()) - 1;
  double u = std::pow((static_cast<double>(i) + 0.5) / kCells, 2);
  for (int step = 0; step < 3; ++step) u -= (linear(u) - value) / slope(u);
  return u;
}

ResponseSpline::Vector ResponseSpline::linear_gradient(double u) const {
  const double at = std::sqrt(std::clamp(u, 0.0, 1.0)) * kCells;
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kCells - 1));
  const double part = at - static_cast<double>(i);
  return (1.0 - part) * gradients_[i] + part * gradients_[i + 1];
}

}  // namespace lumitexel
