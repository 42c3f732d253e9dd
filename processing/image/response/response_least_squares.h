// Maximum likelihood of a response in the samples of brackets, every pixel's rate eliminated: Gauss-Newton.
#pragma once

#include <vector>

#include "processing/image/response/bracket_pixels.h"
#include "processing/image/response/response_prior.h"
#include "processing/image/response/response_spline.h"
#include "processing/image/response/sample_model.h"

namespace lumitexel {

// The normal equations of the curve, every rate eliminated, and what was seen on the way.
struct ReducedEquations {
  ResponseMatrix normal = ResponseMatrix::Zero();
  ResponseSpline::Vector right = ResponseSpline::Vector::Zero();
  double chi_square = 0, samples = 0, lowest = 1, highest = 0;  // lowest, highest: of the predicted codes
  int pixels = 0;
  double shot_chi_square = 0, shot_freedoms = 0;  // of pixels whose noise is shot noise before all

  void add(const ResponseSpline& curve, const UnitSensor& sensor, const BracketPixel& pixel);
};

class ResponseLeastSquares {
 public:
  static constexpr int kFewestPixels = 200;
  static constexpr double kReference = 0.5;  // the scale: L = u here

  ResponseLeastSquares(std::vector<BracketPixel> pixels, const UnitSensor& sensor);

  // Iterations until convergence; 0: none, or fewer than kFewestPixels that tell anything.
  int run();

  const ResponseSpline::Vector& coefficients() const { return coefficients_; }
  const ReducedEquations& reduced() const { return reduced_; }
  // Variance of the light per unit of it, from the residuals if shot_measured(), else the sensor's own.
  double shot() const { return sensor_.shot; }
  bool shot_measured() const { return shot_measured_; }
  ResponseMatrix covariance() const;

 private:
  ResponseMatrix regular() const;
  void start();
  void measure_shot_noise();
  void fix_scale();
  void choose(const ResponseSpline& curve, BracketPixel& pixel) const;
  void improve_rate(const ResponseSpline& curve, BracketPixel& pixel) const;

  std::vector<BracketPixel> pixels_;
  UnitSensor sensor_;
  ResponseSpline::Vector coefficients_;
  ReducedEquations reduced_;
  bool shot_measured_ = false;
};

}  // namespace lumitexel
