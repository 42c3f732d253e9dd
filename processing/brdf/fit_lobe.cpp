#include "processing/brdf/fit_lobe.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "processing/brdf/lobe_need.h"
#include "processing/brdf/lobe_starts.h"
#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

constexpr int kReweightings = 3;  // the weights move little after the second
// N = 1: broader lobes are diffuse light. N = 5000 is a highlight of 1.3 degrees: the normals of a scanned mesh are not
// known so well, and a narrower lobe would sit on single outliers.
constexpr double kMinLogExponent = 0.0, kMaxLogExponent = 8.517193191416238;
constexpr double kMinLogPeak = -16.0;  // 1e-7 per sr: off
// Within about 8 degrees of the mirror direction's parameter (Cz / |Cx| from 0.74 to 1.35). A forward lobe off it further peaks
// where no rig has samples, near grazing, and extrapolates there without bound.
constexpr double kMinPhi = 0.6353981633974483, kMaxPhi = 0.9353981633974483;
// A lobe of exponent N and peak A reflects about 2 pi A / (N + 2) of the light; four times everything is more than
// coarse normals and glancing light can feign.
constexpr double kMostEnergy = 4.0;
constexpr double kConvergedStep = 1e-7;   // relative fall of the cost at which the iteration ends
// Shares of the largest eigenvalue of the scaled normal matrix below which a direction counts as undetermined.
constexpr double kRankTolerance = 1e-12;

double max_log_peak(double log_exponent) {
  constexpr double kTwoPi = 6.283185307179586;
  return std::log(kMostEnergy * (std::exp(log_exponent) + 2.0) / kTwoPi);
}

struct LobeShape {  // D and its slope for one sample, or nothing where D <= 0
  double log_base = 0, slope = 0;  // ln D and d(ln D)/d(phi)
  bool above_zero = false;
};

LobeShape shape_at(double phi, const LobeGeometry& geometry) {
  const double sine = std::sin(phi), cosine = std::cos(phi);
  const double tangential = geometry.wi_dot_wo - geometry.cos_i * geometry.cos_o;
  const double normal_part = geometry.cos_i * geometry.cos_o;
  const double numerator = -sine * tangential + cosine * normal_part;
  LobeShape shape;
  if (numerator <= 0.0) return shape;
  const bool sine_larger = std::abs(sine) > std::abs(cosine);
  const double scale = sine_larger ? std::abs(sine) : std::abs(cosine);
  const double scale_slope = sine_larger ? (sine > 0 ? cosine : -cosine) : (cosine > 0 ? -sine : sine);
  shape.above_zero = true;
  shape.log_base = std::min(0.0, std::log(numerator / scale));
  shape.slope = (-cosine * tangential - sine * normal_part) / numerator - scale_slope / scale;
  return shape;
}

struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  double cost = 0;
};

class Problem {
 public:
  Problem(std::span<const Observation* const> samples, const LobeParameters& layout, const ErrorModel& error)
      : samples_(samples), layout_(layout), error_(error), weights_(samples.size() * kMaxChannels, 0.0) {}

  // Freezes the weights at the given model.
  void reweight(const Eigen::VectorXd& at) {
    LobeParameters parameters = layout_;
    parameters.values = at;
    const LafortuneBrdf model = parameters.brdf();
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      for (int c = 0; c < layout_.channels; ++c) {
        const double predicted = predicted_reflectance(model, c, samples_[s]->geometry);
        weights_[s * kMaxChannels + static_cast<std::size_t>(c)] =
            1.0 / error_.variance(predicted, static_cast<double>(samples_[s]->variance[static_cast<std::size_t>(c)]));
      }
    }
  }

  double cost(const Eigen::VectorXd& at) const {
    double sum = 0.0;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      for (int c = 0; c < layout_.channels; ++c) {
        const double residual = predict(at, *samples_[s], c).value - measured(s, c);
        sum += weight(s, c) * residual * residual;
      }
    }
    return sum;
  }

  NormalEquations linearise(const Eigen::VectorXd& at) const {
    NormalEquations equations{Eigen::MatrixXd::Zero(layout_.size(), layout_.size()),
                              Eigen::VectorXd::Zero(layout_.size()), 0.0};
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      for (int c = 0; c < layout_.channels; ++c) add(predict(at, *samples_[s], c), s, c, equations);
    }
    return equations;
  }

 private:
  struct Prediction {
    double value = 0;
    std::array<double, 4> slope{};  // by kd, ln A, phi, ln N of the channel
  };

  double weight(std::size_t s, int c) const { return weights_[s * kMaxChannels + static_cast<std::size_t>(c)]; }
  double measured(std::size_t s, int c) const {
    return static_cast<double>(samples_[s]->reflectance[static_cast<std::size_t>(c)]);
  }

  Prediction predict(const Eigen::VectorXd& at, const Observation& sample, int c) const {
    const double cos_i = sample.geometry.cos_i;
    const LobeShape shape = shape_at(at[layout_.phi(c)], sample.geometry);
    const double exponent = std::exp(at[layout_.log_exponent(c)]);
    const double lobe =
        shape.above_zero ? cos_i * std::exp(at[layout_.log_peak(c)] + exponent * shape.log_base) : 0.0;
    return {cos_i * at[layout_.diffuse(c)] + lobe,
            {cos_i, lobe, lobe * exponent * shape.slope, lobe * exponent * shape.log_base}};
  }

  void add(const Prediction& prediction, std::size_t s, int c, NormalEquations& equations) const {
    const std::array<int, 4> row{layout_.diffuse(c), layout_.log_peak(c), layout_.phi(c), layout_.log_exponent(c)};
    const double residual = prediction.value - measured(s, c), w = weight(s, c);
    equations.cost += w * residual * residual;
    for (std::size_t i = 0; i < 4; ++i) {
      const double weighted = w * prediction.slope[i];
      equations.gradient[row[i]] += weighted * residual;
      for (std::size_t j = 0; j < 4; ++j) equations.matrix(row[i], row[j]) += weighted * prediction.slope[j];
    }
  }

  std::span<const Observation* const> samples_;
  LobeParameters layout_;
  ErrorModel error_;
  std::vector<double> weights_;
};

void clamp_into_range(const LobeParameters& layout, Eigen::VectorXd& values) {
  for (int c = 0; c < layout.channels; ++c) {
    values[layout.diffuse(c)] = std::max(0.0, values[layout.diffuse(c)]);
    values[layout.phi(c)] = std::clamp(values[layout.phi(c)], kMinPhi, kMaxPhi);
    values[layout.log_exponent(c)] = std::clamp(values[layout.log_exponent(c)], kMinLogExponent, kMaxLogExponent);
    values[layout.log_peak(c)] =
        std::clamp(values[layout.log_peak(c)], kMinLogPeak, max_log_peak(values[layout.log_exponent(c)]));
  }
}

// A parameter that stands at its bound and would be pushed beyond takes no part in the step.
std::vector<bool> held_at_bound(const LobeParameters& layout, const Eigen::VectorXd& at, const Eigen::VectorXd& gradient) {
  std::vector<bool> held(static_cast<std::size_t>(layout.size()), false);
  const auto check = [&](int i, double low, double high) {
    if ((at[i] <= low && gradient[i] > 0.0) || (at[i] >= high && gradient[i] < 0.0)) held[static_cast<std::size_t>(i)] = true;
  };
  for (int c = 0; c < layout.channels; ++c) {
    check(layout.diffuse(c), 0.0, std::numeric_limits<double>::infinity());
    check(layout.log_peak(c), kMinLogPeak, max_log_peak(at[layout.log_exponent(c)]));
    check(layout.phi(c), kMinPhi, kMaxPhi);
    check(layout.log_exponent(c), kMinLogExponent, kMaxLogExponent);
  }
  return held;
}

// (J^T J + lambda diag) step = -gradient over the parameters that are free.
Eigen::VectorXd damped_step(const NormalEquations& equations, const std::vector<bool>& held, double lambda) {
  Eigen::MatrixXd matrix = equations.matrix;
  Eigen::VectorXd right = -equations.gradient;
  const double smallest = 1e-14 * std::max(1e-300, matrix.diagonal().maxCoeff());
  for (int i = 0; i < matrix.rows(); ++i) {
    matrix(i, i) += lambda * matrix(i, i) + smallest;
    if (!held[static_cast<std::size_t>(i)]) continue;
    matrix.row(i).setZero();
    matrix.col(i).setZero();
    matrix(i, i) = 1.0;
    right[i] = 0.0;
  }
  return matrix.ldlt().solve(right);
}

struct Descent {
  Eigen::VectorXd values;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
};

Descent levenberg_marquardt(const Problem& problem, const LobeParameters& layout, Eigen::VectorXd values, int max_iterations) {
  Descent descent{std::move(values), 0.0, 0, false};
  double lambda = 1e-3;
  while (descent.iterations < max_iterations) {
    const NormalEquations equations = problem.linearise(descent.values);
    descent.cost = equations.cost;
    const std::vector<bool> held = held_at_bound(layout, descent.values, equations.gradient);
    bool improved = false;
    for (int attempt = 0; attempt < 8 && !improved; ++attempt) {
      Eigen::VectorXd trial = descent.values + damped_step(equations, held, lambda);
      clamp_into_range(layout, trial);
      const double cost = trial.allFinite() ? problem.cost(trial) : std::numeric_limits<double>::infinity();
      improved = cost < descent.cost;
      if (!improved) {
        lambda *= 8.0;
        continue;
      }
      descent.converged = descent.cost - cost <= kConvergedStep * descent.cost;
      descent.values = trial;
      descent.cost = cost;
      lambda = std::max(1e-10, lambda / 6.0);
    }
    ++descent.iterations;
    if (!improved) descent.converged = true;  // no downhill step of any size is left
    if (descent.converged) break;
  }
  return descent;
}

// Inverse of the normal matrix in a scaling that makes its diagonal one; directions without information get zero.
Eigen::MatrixXd covariance_of(const NormalEquations& equations, const std::vector<bool>& held, bool& rank_deficient) {
  const Eigen::Index n = equations.matrix.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double diagonal = equations.matrix(i, i);
    if (!held[static_cast<std::size_t>(i)] && diagonal > 0.0) scale[i] = 1.0 / std::sqrt(diagonal);
    else if (!held[static_cast<std::size_t>(i)]) rank_deficient = true;
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * equations.matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n);
  int determined = 0, wanted = 0;
  for (Eigen::Index i = 0; i < n; ++i) wanted += scale[i] > 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (eigen.eigenvalues()[i] <= kRankTolerance * static_cast<double>(n)) continue;
    inverse[i] = 1.0 / eigen.eigenvalues()[i];
    ++determined;
  }
  if (determined < wanted) rank_deficient = true;
  const Eigen::MatrixXd root = scale.asDiagonal() * eigen.eigenvectors();
  return root * inverse.asDiagonal() * root.transpose();
}

// What the covariance said about the lobe goes with it.
void switch_lobe_off(const LafortuneBrdf& matte, const LobeParameters& layout, LobeFit& fit) {
  fit.brdf.diffuse = matte.diffuse;
  for (auto& lobe : fit.brdf.lobes[0]) lobe = LafortuneLobe{kMinLogPeak};
  const int others = layout.size() - layout.channels;
  fit.covariance.bottomRows(others).setZero();
  fit.covariance.rightCols(others).setZero();
}

LobeFit fit_from(const LafortuneBrdf& start, std::span<const Observation* const> samples, LobeParameters layout,
                 const LobeFitOptions& options) {
  LobeFit fit;
  Eigen::VectorXd values = LobeParameters::from(start, options.shared_shape).values;
  Problem problem(samples, layout, options.error);
  for (int round = 0; round < kReweightings; ++round) {
    problem.reweight(values);
    const Descent descent = levenberg_marquardt(problem, layout, values, options.max_iterations);
    values = descent.values;
    fit.iterations += descent.iterations;
    fit.converged = descent.converged;
  }
  problem.reweight(values);
  const NormalEquations equations = problem.linearise(values);
  const auto residuals = static_cast<double>(samples.size()) * layout.channels;
  fit.cost = equations.cost / residuals;
  const double spread = equations.cost / std::max(1.0, residuals - layout.size());
  fit.covariance = spread * covariance_of(equations, held_at_bound(layout, values, equations.gradient), fit.rank_deficient);
  layout.values = values;
  fit.brdf = layout.brdf();
  return fit;
}

}  // namespace

LobeParameters LobeParameters::from(const LafortuneBrdf& brdf, bool shared_shape) {
  LobeParameters parameters;
  parameters.channels = brdf.channels;
  parameters.shared_shape = shared_shape;
  parameters.values = Eigen::VectorXd::Zero(parameters.size());
  for (int c = 0; c < brdf.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const LafortuneLobe lobe = brdf.lobes.empty() ? LafortuneLobe{kMinLogPeak} : brdf.lobes[0][channel];
    parameters.values[parameters.diffuse(c)] = brdf.diffuse[channel];
    parameters.values[parameters.log_peak(c)] = lobe.log_peak;
    parameters.values[parameters.phi(c)] = lobe.phi;
    parameters.values[parameters.log_exponent(c)] = lobe.log_exponent;
  }
  clamp_into_range(parameters, parameters.values);
  return parameters;
}

LafortuneBrdf LobeParameters::brdf() const {
  Eigen::VectorXd clamped = values;
  clamp_into_range(*this, clamped);
  LafortuneBrdf brdf;
  brdf.channels = channels;
  brdf.lobes.resize(1);
  for (int c = 0; c < channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    brdf.diffuse[channel] = clamped[diffuse(c)];
    brdf.lobes[0][channel] = {clamped[log_peak(c)], clamped[phi(c)], clamped[log_exponent(c)]};
  }
  return brdf;
}

LobeFit fit_one_lobe(std::span<const Observation* const> samples, int channels, const LafortuneBrdf* start,
                     const LobeFitOptions& options) {
  LobeFit fit;
  fit.brdf.channels = channels;
  LobeParameters layout;
  layout.channels = channels;
  layout.shared_shape = options.shared_shape;
  fit.covariance = Eigen::MatrixXd::Zero(layout.size(), layout.size());
  fit.rank_deficient = samples.empty();
  if (samples.empty()) return fit;

  fit = fit_from(best_lobe_start(samples, channels, options.error), samples, layout, options);
  if (start != nullptr) {
    const LobeFit other = fit_from(*start, samples, layout, options);
    if (misfit(other.brdf, samples, options.error) < misfit(fit.brdf, samples, options.error)) fit = other;
  }
  const LafortuneBrdf matte = diffuse_alone(samples, options.error, fit.brdf);
  fit.has_lobe = lobe_is_needed(samples, options.error, fit.brdf, matte, layout.size() - layout.channels);
  if (!fit.has_lobe) switch_lobe_off(matte, layout, fit);
  return fit;
}

}  // namespace lumitexel
