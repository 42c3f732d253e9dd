// The least-squares problem of a BRDF fit: whitened residuals of weighted samples and their normal equations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/brdf/brdf_slopes.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

struct NormalEquations {
  Eigen::MatrixXd matrix;     // J^T J
  Eigen::VectorXd gradient;   // J^T e
  double cost = 0;            // e^T e
};

NormalEquations& operator+=(NormalEquations& a, const NormalEquations& b);

// Solves (J^T J + damping * diagonal) step = -gradient over the parameters that are not held.
Eigen::VectorXd damped_step(const NormalEquations& equations, const std::vector<bool>& held, double damping);

class BrdfProblem {
 public:
  BrdfProblem(FitSamples samples, const BrdfParameters& layout, const ErrorModel& error, bool robust);

  // Freezes scales and robust weights at the given parameters.
  void reweight(const Eigen::VectorXd& at);
  double cost(const Eigen::VectorXd& at) const;
  NormalEquations linearise(const Eigen::VectorXd& at) const;
  double total_weight() const;  // of the samples, as frozen
  // Sum over lumitexels of g g^T, g the gradient J^T e of all of a lumitexel's samples together: how far the gradient strays by chance where
  // lumitexels are independent of each other and their own samples are not.
  Eigen::MatrixXd scatter_by_lumitexel(const Eigen::VectorXd& at) const;
  // Slope of a sample's whitened residual times its robust weight, by the residual, over that weight, mean over samples: 1 where every sample counts
  // in full, below where an outlying one counts the less the farther out it is. J^T e changes by so much of J^T J.
  double robust_slope(const Eigen::VectorXd& at) const;

 private:
  struct SampleWeight {
    std::array<double, kMaxChannels> inverse_scale{};
    double root = 0;  // of share times robust weight
  };
  void add(const BrdfSlopes& model, std::size_t sample, NormalEquations& sums) const;

  FitSamples samples_;
  const BrdfParameters& layout_;
  const ErrorModel& error_;
  bool robust_;
  std::vector<SampleWeight> weights_;
};

}  // namespace lumitexel
