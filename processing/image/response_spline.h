// A monotone curve over [0, 1]: the integral of the exponential of q, tabulated with its derivatives. q is a cubic spline,
// coefficients 0 … kSplines - 1, plus the last coefficient times log(u + 0.002): gammas bend more sharply near black than
// splines do.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumitexel {

class ResponseSpline {
 public:
  static constexpr int kSplines = 11, kCoefficients = kSplines + 1;
  using Vector = Eigen::Matrix<double, kCoefficients, 1>;

  explicit ResponseSpline(const Vector& coefficients);

  static Vector basis(double u);          // of q: q(u) = basis(u) . coefficients
  double linear(double u) const;          // L(u); continued straight outside [0, 1]
  double slope(double u) const;           // dL/du, positive
  double inverse(double linear) const;    // u
  Vector linear_gradient(double u) const; // dL/dc
  // The most that it is tabulated for.
  double highest() const { return values_.back(); }

 private:
  static constexpr int kCells = 512;
  std::vector<double> values_, slopes_;
  std::vector<Vector> gradients_;
};

}  // namespace lumitexel
