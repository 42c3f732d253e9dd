// A monotone curve over [0, 1]: the integral of the exponential of q, tabulated with its derivatives. q is a cubic
// spline whose knots are equidistant in place(u) = log(1 + u / kToe), scaled to [0, 1]: responses bend in proportion to
// the code (the log slope of a gamma is a straight line over log u), but none bends ever more sharply towards black.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumitexel {

class ResponseSpline {
 public:
  static constexpr int kCoefficients = 17;
  using Vector = Eigen::Matrix<double, kCoefficients, 1>;

  explicit ResponseSpline(const Vector& coefficients);

  static double place(double u);
  static double at_place(double place);    // u
  static Vector basis(double u);           // of q: q(u) = basis(u) . coefficients
  double linear(double u) const;           // L(u); continued straight outside [0, 1]
  double slope(double u) const;            // dL/du, positive
  double log_slope_slope(double u) const;  // d log(dL/du) / du
  double inverse(double linear) const;     // u
  Vector linear_gradient(double u) const;  // dL/dc
  // The most that it is tabulated for.
  double highest() const { return values_.back(); }

 private:
  static constexpr int kCells = 512;
  static constexpr double kToe = 0.01;
  struct Within {
    std::size_t cell;
    double part;  // of the way through the cell; the slope is taken for linear there
  };
  Within within(double u) const;
  std::vector<double> nodes_, values_, slopes_;
  std::vector<Vector> gradients_;
};

}  // namespace lumitexel
