// A monotone curve over [0, 1]: the integral of the exponential of q, tabulated with its derivatives. q is a cubic
// spline whose knots are equidistant in place(u) = log(1 + u / kToe), scaled to [0, 1]: responses bend in proportion to
// the code (the log slope of a gamma is a straight line over log u), but none bends ever more sharply towards black.
// Kinks may be added to q, each bend * max(0, place(u) - where): sRGB's toe, a line, ends with one.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumitexel {

class ResponseSpline {
 public:
  static constexpr int kCoefficients = 17, kMostKinks = 2, kOfKink = 2,
                       kMostParameters = kCoefficients + kOfKink * kMostKinks;
  static constexpr int kSpans = kCoefficients - 3;  // between knots
  using Coefficients = Eigen::Matrix<double, kCoefficients, 1>;
  // The spline's coefficients, then each kink's bend and place.
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostParameters, 1>;

  explicit ResponseSpline(const Vector& parameters);

  static double place(double u);
  static double at_place(double place);    // u
  static Coefficients basis(double u);     // of q: q(u) = basis(u) . coefficients + kinks
  double linear(double u) const;           // L(u); continued straight outside [0, 1]
  double slope(double u) const;            // dL/du, positive
  double log_slope_slope(double u) const;  // d log(dL/du) / du
  double inverse(double linear) const;     // u
  Vector linear_gradient(double u) const;  // dL/dparameters
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
