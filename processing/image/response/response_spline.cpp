#include "processing/image/response/response_spline.h"

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

double ResponseSpline::place(double u) { return std::log1p(u / kToe) / std::log1p(1.0 / kToe); }
double ResponseSpline::at_place(double place) { return kToe * std::expm1(place * std::log1p(1.0 / kToe)); }

ResponseSpline::Vector ResponseSpline::basis(double u) {
  constexpr int kSpans = kCoefficients - 3;
  const double at = place(std::clamp(u, 0.0, 1.0)) * kSpans;
  const int span = std::min(static_cast<int>(at), kSpans - 1);
  const std::array<double, 4> blend = blends(at - span);
  Vector values = Vector::Zero();
  for (int k = 0; k < 4; ++k) values[span + k] = blend[static_cast<std::size_t>(k)];
  return values;
}

// Simpson's rule over cells equidistant in place as well: the integrand is smooth in it.
ResponseSpline::ResponseSpline(const Vector& c) {
  const double ds = 1.0 / kCells, stretch = std::log1p(1.0 / kToe);
  double value = 0.0;
  Vector gradient = Vector::Zero();
  for (int i = 0; i <= kCells; ++i) {
    const double u0 = at_place(i * ds), u1 = at_place((i + 0.5) * ds), u2 = at_place((i + 1.0) * ds);
    const Vector here = basis(u0);
    const double slope = std::exp(here.dot(c));
    nodes_.push_back(u0);
    values_.push_back(value);
    slopes_.push_back(slope);
    gradients_.push_back(gradient);
    if (i == kCells) break;
    const Vector middle = basis(u1), next = basis(u2);
    const double f0 = stretch * (u0 + kToe) * slope, f1 = stretch * (u1 + kToe) * std::exp(middle.dot(c)),
                 f2 = stretch * (u2 + kToe) * std::exp(next.dot(c));
    value += ds / 6.0 * (f0 + 4.0 * f1 + f2);
    gradient += ds / 6.0 * (f0 * here + 4.0 * f1 * middle + f2 * next);
  }
}

ResponseSpline::Within ResponseSpline::within(double u) const {
  const double inside = std::clamp(u, 0.0, 1.0);
  const auto cell = std::min(static_cast<std::size_t>(place(inside) * kCells), static_cast<std::size_t>(kCells - 1));
  return {cell, (inside - nodes_[cell]) / (nodes_[cell + 1] - nodes_[cell])};
}

double ResponseSpline::linear(double u) const {
  if (u <= 0.0) return u * slopes_.front();
  if (u >= 1.0) return values_.back() + (u - 1.0) * slopes_.back();
  const auto [i, part] = within(u);
  return values_[i] + (u - nodes_[i]) * (slopes_[i] + 0.5 * part * (slopes_[i + 1] - slopes_[i]));
}

double ResponseSpline::slope(double u) const {
  const auto [i, part] = within(u);
  return (1.0 - part) * slopes_[i] + part * slopes_[i + 1];
}

double ResponseSpline::log_slope_slope(double u) const {
  const std::size_t i = within(u).cell;
  return std::log(slopes_[i + 1] / slopes_[i]) / (nodes_[i + 1] - nodes_[i]);
}

double ResponseSpline::inverse(double value) const {
  if (value <= 0.0) return value / slopes_.front();
  if (value >= values_.back()) return 1.0 + (value - values_.back()) / slopes_.back();
  const auto above = std::upper_bound(values_.begin(), values_.end(), value);
  const auto i = static_cast<std::size_t>(above - values_.begin()) - 1;
  // The root of the cell's parabola, in the form that a straight line does not upset.
  const double bend = (slopes_[i + 1] - slopes_[i]) / (nodes_[i + 1] - nodes_[i]), over = value - values_[i];
  return nodes_[i] + 2.0 * over / (slopes_[i] + std::sqrt(std::max(0.0, slopes_[i] * slopes_[i] + 2.0 * bend * over)));
}

ResponseSpline::Vector ResponseSpline::linear_gradient(double u) const {
  const auto [i, part] = within(u);
  return (1.0 - part) * gradients_[i] + part * gradients_[i + 1];
}

}  // namespace lumitexel
