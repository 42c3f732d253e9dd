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
  ResponseMatrix normal;
  ResponseSpline::Vector right;
  double chi_square = 0, samples = 0, lowest = 1, highest = 0;  // lowest, highest: of the predicted codes
  double surprise = 0;                                          // -2 log likelihood, up to a constant
  int pixels = 0;
  double shot_chi_square = 0, shot_freedoms = 0;  // of pixels whose noise is shot noise before all

  explicit ReducedEquations(Eigen::Index parameters);
  void add(const ResponseSpline& curve, const UnitSensor& sensor, const BracketPixel& pixel);
};

class ResponseLeastSquares {
 public:
  static constexpr int kFewestPixels = 200;
  static constexpr double kReference = 0.5;  // the scale: L = u here

  ResponseLeastSquares(std::vector<BracketPixel> pixels, const UnitSensor& sensor);

  // Chooses samples, measures the shot noise and fits a curve without kinks. Iterations until convergence; 0: none, or
  // fewer than kFewestPixels that tell anything.
  int run();
  // Goes on from `start`; samples and shot noise stay, so that surprise() compares. Iterations until convergence, or 0.
  int run_from(const ResponseSpline::Vector& start);

  const ResponseSpline::Vector& parameters() const { return parameters_; }
  int kinks() const {
    return static_cast<int>(parameters_.size() - ResponseSpline::kCoefficients) / ResponseSpline::kOfKink;
  }
  const ReducedEquations& reduced() const { return reduced_; }
  // -2 log of the evidence, the probability of the chosen samples whatever the parameters are, up to a constant that
  // only their choice changes.
  double surprise() const;
  // Root of the residuals' reduced chi-square.
  double residual_scale() const;
  // Variance of the light per unit of it, from the residuals if shot_measured(), else the sensor's own.
  double shot() const { return sensor_.shot; }
  bool shot_measured() const { return shot_measured_; }
  double bend_sigma() const { return bend_sigma_; }  // of the prior, chosen by the samples
  ResponseMatrix covariance() const;

 private:
  int iterate(int settling, int most);
  void reduce(bool settles);
  bool take_step();
  double scale_weight() const;
  ResponseMatrix regular() const;
  void start();
  void measure_shot_noise();
  void fix_scale();
  void choose(const ResponseSpline& curve, BracketPixel& pixel) const;
  void improve_rate(const ResponseSpline& curve, BracketPixel& pixel) const;

  std::vector<BracketPixel> pixels_;
  UnitSensor sensor_;
  ResponseSpline::Vector parameters_;
  ReducedEquations reduced_;
  double bend_sigma_ = kTypicalBend;
  double gain_ = 0.0;  // of the last step, in units of chi-square
  bool shot_measured_ = false;
};

}  // namespace lumitexel
