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

struct LogSlope {
  double u, q;
  ResponseSpline::Vector by_parameters;  // dq
};

LogSlope log_slope(const ResponseSpline::Vector& parameters, double place) {
  constexpr int kSpline = ResponseSpline::kCoefficients;
  LogSlope at{ResponseSpline::at_place(place), 0.0, ResponseSpline::Vector::Zero(parameters.size())};
  at.by_parameters.head<kSpline>() = ResponseSpline::basis(at.u);
  at.q = at.by_parameters.head<kSpline>().dot(parameters.head<kSpline>());
  for (Eigen::Index k = kSpline; k < parameters.size(); k += ResponseSpline::kOfKink) {
    const double beyond = std::max(0.0, place - parameters[k + 1]);
    at.q += parameters[k] * beyond;
    at.by_parameters[k] = beyond;
    at.by_parameters[k + 1] = beyond > 0.0 ? -parameters[k] : 0.0;
  }
  return at;
}

}  // namespace

double ResponseSpline::place(double u) { return std::log1p(u / kToe) / std::log1p(1.0 / kToe); }
double ResponseSpline::at_place(double place) { return kToe * std::expm1(place * std::log1p(1.0 / kToe)); }

ResponseSpline::Coefficients ResponseSpline::basis(double u) {
  const double at = place(std::clamp(u, 0.0, 1.0)) * kSpans;
  const int span = std::min(static_cast<int>(at), kSpans - 1);
  const std::array<double, 4> blend = blends(at - span);
  Coefficients values = Coefficients::Zero();
  for (int k = 0; k < 4; ++k) values[span + k] = blend[static_cast<std::size_t>(k)];
  return values;
}

// Simpson's rule over cells equidistant in place as well: the integrand is smooth in it, but for kinks.
ResponseSpline::ResponseSpline(const Vector& parameters) {
  const double ds = 1.0 / kCells, stretch = std::log1p(1.0 / kToe);
  double value = 0.0;
  Vector gradient = Vector::Zero(parameters.size());
  LogSlope here = log_slope(parameters, 0.0);
  for (int i = 0; i <= kCells; ++i) {
    nodes_.push_back(here.u);
    values_.push_back(value);
    slopes_.push_back(std::exp(here.q));
    gradients_.push_back(gradient);
    if (i == kCells) break;
    const LogSlope middle = log_slope(parameters, (i + 0.5) * ds), next = log_slope(parameters, (i + 1.0) * ds);
    const double f0 = stretch * (here.u + kToe) * std::exp(here.q),
                 f1 = stretch * (middle.u + kToe) * std::exp(middle.q),
                 f2 = stretch * (next.u + kToe) * std::exp(next.q);
    value += ds / 6.0 * (f0 + 4.0 * f1 + f2);
    gradient += ds / 6.0 * (f0 * here.by_parameters + 4.0 * f1 * middle.by_parameters + f2 * next.by_parameters);
    here = next;
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
