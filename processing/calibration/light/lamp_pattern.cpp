#include "processing/calibration/light/lamp_pattern.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Parameters = LampPattern::Parameters;

constexpr double kLeastCosine = 1e-3;
constexpr double kOutlierSigmas = 5.0;
// Chi-square that a parameter has to save, over the residuals' own scale: a needless one saves 15 once in 10,000 fits.
constexpr double kLeastGain = 15.0;

// What lamps are like before any sample: pointed at the pivot to some ten degrees, not narrower than a torch. A board that
// fills a few degrees would else be explained by a lamp that points far aside.
const Eigen::Vector4d kPriorSigma(30.0, 0.17, 0.17, 30.0);

Eigen::Vector3d lamp_axis(const Parameters& p) { return Eigen::Vector3d(p[1], p[2], 1.0).normalized(); }

double log_term(const Parameters& p, double cosine) {
  const double l = -std::log(std::max(cosine, kLeastCosine));
  return l * (-p[0] + p[3] * l);
}

double log_pattern(const Parameters& p, const Eigen::Vector3d& unit) {
  const Eigen::Vector3d axis = lamp_axis(p);
  return log_term(p, unit.dot(axis)) - log_term(p, axis.z());
}

// Of log_term at the angle between `unit` and the axis.
Eigen::RowVector4d term_gradient(const Parameters& p, const Eigen::Vector3d& axis, const Eigen::Vector3d& unit) {
  const double cosine = std::max(unit.dot(axis), kLeastCosine), l = -std::log(cosine);
  const double by_cosine = (p[0] - 2.0 * p[3] * l) / cosine;
  const Eigen::Vector2d by_tilt = axis.z() * (unit.head<2>() - cosine * axis.head<2>());  // axis.z is 1 / |(tilt, 1)|
  return {-l, by_cosine * by_tilt.x(), by_cosine * by_tilt.y(), l * l};
}

Eigen::RowVector4d gradient(const Parameters& p, const Eigen::Vector3d& unit) {
  const Eigen::Vector3d axis = lamp_axis(p);
  return term_gradient(p, axis, unit) - term_gradient(p, axis, Eigen::Vector3d::UnitZ());
}

struct LogSample {
  std::size_t view;
  Eigen::Vector3d direction;
  double value, sigma;  // log of the intensity into `direction`
};

std::vector<LogSample> usable(const std::vector<PatternSample>& samples) {
  std::vector<LogSample> result;
  for (const PatternSample& s : samples) {
    if (s.view < 0 || !(s.variance > 0.0) || !std::isfinite(s.variance) || !std::isfinite(s.radiance)) {
      throw BadInput("lamp pattern", "a sample of view " + std::to_string(s.view) + " with variance " +
                                         std::to_string(s.variance),
                     "views from 0 on, positive finite variances");
    }
    const double distance = s.position_in_lamp.norm();
    const Eigen::Vector3d d = s.position_in_lamp / distance;
    const double cosine = -d.dot(s.normal_in_lamp);
    if (!(cosine > kLeastCosine) || !(d.z() > kLeastCosine) || !(s.radiance > 0.0)) continue;
    const double sigma = std::sqrt(s.variance) / s.radiance;
    result.push_back({static_cast<std::size_t>(s.view), d, std::log(s.radiance * distance * distance / cosine), sigma});
  }
  return result;
}

struct State {
  Parameters p = Parameters::Zero();
  std::vector<double> intercept;  // log intensity per view
  double chi2 = std::numeric_limits<double>::infinity();
  bool converged = false;
};

class PatternProblem {
 public:
  explicit PatternProblem(std::vector<LogSample> samples) : samples_(std::move(samples)) {
    for (const LogSample& s : samples_) views_ = std::max(views_, s.view + 1);
  }
  const std::vector<LogSample>& samples() const { return samples_; }
  std::size_t views() const { return views_; }

  // Cauchy loss in units of the scale.
  static double weight(double r, double scale) { return 1.0 / (1.0 + r * r / (kOutlierSigmas * kOutlierSigmas * scale * scale)); }

  double residual(const State& state, const LogSample& s) const {
    return (s.value - state.intercept[s.view] - log_pattern(state.p, s.direction)) / s.sigma;
  }
  double cost(const State& state, double scale) const {
    const double bound2 = kOutlierSigmas * kOutlierSigmas * scale * scale;
    double sum = scale * scale * state.p.cwiseQuotient(kPriorSigma).squaredNorm();
    for (const LogSample& s : samples_) sum += bound2 * std::log1p(std::pow(residual(state, s), 2) / bound2);
    return sum;
  }

  // Intercepts are eliminated: each view's rows are centred by their weighted mean.
  struct Reduced {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::vector<Eigen::RowVector4d> mean_row;
    std::vector<double> mean_value, weight;
  };
  Reduced reduce(const State& state, double scale) const {
    Reduced r;
    r.mean_row.assign(views_, Eigen::RowVector4d::Zero());
    r.mean_value.assign(views_, 0.0);
    r.weight.assign(views_, 0.0);
    for (const LogSample& s : samples_) {
      const double w = weight(residual(state, s), scale) / (s.sigma * s.sigma);
      const double value = s.value - log_pattern(state.p, s.direction);
      const Eigen::RowVector4d row = gradient(state.p, s.direction);
      r.normal += w * row.transpose() * row;
      r.right += w * row.transpose() * value;
      r.mean_row[s.view] += w * row;
      r.mean_value[s.view] += w * value;
      r.weight[s.view] += w;
    }
    for (std::size_t v = 0; v < views_; ++v) {
      if (r.weight[v] <= 0.0) continue;
      r.normal -= r.mean_row[v].transpose() * r.mean_row[v] / r.weight[v];
      r.right -= r.mean_row[v].transpose() * r.mean_value[v] / r.weight[v];
    }
    const Eigen::Vector4d prior = scale * scale * kPriorSigma.cwiseAbs2().cwiseInverse();
    r.normal += prior.asDiagonal();
    r.right -= prior.cwiseProduct(state.p);
    return r;
  }

  State solve(const std::array<bool, 4>& free, State state, double scale) const;

 private:
  std::vector<LogSample> samples_;
  std::size_t views_ = 0;
};

// Inverse over the free parameters, zero elsewhere.
Eigen::Matrix4d free_inverse(Eigen::Matrix4d normal, const std::array<bool, 4>& free) {
  Eigen::Matrix4d mask = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 4; ++k) {
    if (free[static_cast<std::size_t>(k)]) {
      mask(k, k) = 1.0;
      continue;
    }
    normal.row(k).setZero();
    normal.col(k).setZero();
    normal(k, k) = 1.0;
  }
  return mask * normal.ldlt().solve(Eigen::Matrix4d::Identity()) * mask;
}

State PatternProblem::solve(const std::array<bool, 4>& free, State state, double scale) const {
  constexpr int kMaxIterations = 100;
  double damping = 1e-6;
  state.chi2 = cost(state, scale);
  for (int iteration = 0; iteration < kMaxIterations && !state.converged; ++iteration) {
    const Reduced r = reduce(state, scale);
    bool improved = false;
    for (; !improved && damping < 1e8; damping *= improved ? 0.1 : 10.0) {
      Eigen::Matrix4d damped = r.normal;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::Vector4d step = free_inverse(damped, free) * r.right;
      State next = state;
      next.p += step;
      for (std::size_t v = 0; v < views_; ++v) {
        if (r.weight[v] > 0.0) next.intercept[v] = (r.mean_value[v] - r.mean_row[v].dot(step)) / r.weight[v];
      }
      next.chi2 = cost(next, scale);
      improved = next.chi2 <= state.chi2;
      if (!improved) continue;
      state.converged = state.chi2 - next.chi2 < 1e-9 * (1.0 + state.chi2) && damping < 1.0;
      next.converged = state.converged;
      state = next;
    }
    if (!improved) break;
  }
  return state;
}

double residual_scale(const PatternProblem& problem, const State& state) {
  std::vector<double> sizes;
  for (const LogSample& s : problem.samples()) sizes.push_back(std::abs(problem.residual(state, s)));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(1.0, 1.4826 * *middle);
}

State start_state(const PatternProblem& problem) {
  State state;
  std::vector<std::vector<double>> by_view(problem.views());
  for (const LogSample& s : problem.samples()) by_view[s.view].push_back(s.value);
  for (std::vector<double>& values : by_view) {
    if (values.empty()) {
      state.intercept.push_back(0.0);
      continue;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    state.intercept.push_back(*middle);
  }
  return state;
}

// n and tilt from the pattern's expansion about z, which is linear: log p = n (tilt . u) - n |u|^2 / 2, u = (x, y) / z.
Parameters expanded_pattern(const PatternProblem& problem) {
  std::vector<Eigen::Vector4d> sums(problem.views(), Eigen::Vector4d::Zero());  // of u, |u|^2 / 2, log value
  std::vector<double> counts(problem.views(), 0.0);
  const auto terms = [](const LogSample& s) {
    const Eigen::Vector2d u = s.direction.head<2>() / s.direction.z();
    return Eigen::Vector4d(u.x(), u.y(), 0.5 * u.squaredNorm(), s.value);
  };
  for (const LogSample& s : problem.samples()) {
    sums[s.view] += terms(s);
    counts[s.view] += 1.0;
  }
  Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const LogSample& s : problem.samples()) {
    const Eigen::Vector4d t = terms(s) - sums[s.view] / counts[s.view];
    normal += t.head<3>() * t.head<3>().transpose();
    right += t.head<3>() * t[3];
  }
  const Eigen::Vector3d solution = normal.ldlt().solve(right);
  constexpr double kLeastExponent = 0.5, kMostExponent = 60.0;
  const double n = std::clamp(-solution.z(), kLeastExponent, kMostExponent);
  const Eigen::Vector2d tilt = (solution.head<2>() / n).cwiseMax(-kPriorSigma[1]).cwiseMin(kPriorSigma[1]);
  return {n, tilt.x(), tilt.y(), 0.0};
}

PatternFit summary_of(const PatternProblem& problem, const State& state, const std::array<bool, 4>& free) {
  PatternFit fit;
  fit.converged = state.converged;
  double chi2 = 0.0;
  const double scale = residual_scale(problem, state);
  for (const LogSample& s : problem.samples()) {
    fit.widest_rad = std::max(fit.widest_rad, std::acos(std::min(1.0, s.direction.z())));
    const double r = problem.residual(state, s);
    if (std::abs(r) > kOutlierSigmas * scale) {
      ++fit.outliers;
      continue;
    }
    chi2 += r * r;
    ++fit.samples;
  }
  const auto reduced = problem.reduce(state, scale);
  for (const bool f : free) fit.parameters += f;
  const auto views = std::count_if(reduced.weight.begin(), reduced.weight.end(), [](double w) { return w > 0.0; });
  const double freedom = fit.samples - fit.parameters - static_cast<double>(views);
  fit.chi2_per_freedom = freedom > 0.0 ? chi2 / freedom : 0.0;
  const double inflation = std::max(1.0, fit.chi2_per_freedom);
  const Eigen::Matrix4d covariance = inflation * free_inverse(reduced.normal, free);
  fit.pattern = LampPattern(state.p, covariance);
  for (std::size_t v = 0; v < problem.views(); ++v) {
    const double w = reduced.weight[v];
    const Eigen::RowVector4d mean = w > 0.0 ? Eigen::RowVector4d(reduced.mean_row[v] / w) : Eigen::RowVector4d::Zero();
    fit.view_intensity.push_back(w > 0.0 ? std::exp(state.intercept[v]) : 0.0);
    fit.view_relative_sigma.push_back(
        w > 0.0 ? std::sqrt(inflation / w + mean.dot(covariance * mean.transpose())) : 0.0);
  }
  return fit;
}

}  // namespace

Eigen::Isometry3d lamp_from_rig(const Eigen::Vector3d& light_in_rig, const Eigen::Vector3d& pivot_in_rig,
                                const Eigen::Vector3d& up_in_rig) {
  const Eigen::Vector3d to_pivot = pivot_in_rig - light_in_rig;
  const double distance = to_pivot.norm();
  const Eigen::Vector3d across = up_in_rig.cross(to_pivot);
  constexpr double kLeastSine = 1e-9;
  if (!(distance > 0.0) || !(across.norm() > kLeastSine * distance * up_in_rig.norm())) {
    throw BadInput("lamp frame", "a light on the arm's pivot or straight above it", "an axis with an upright");
  }
  const Eigen::Vector3d z = to_pivot / distance, x = across.normalized();
  Eigen::Isometry3d lamp = Eigen::Isometry3d::Identity();
  lamp.linear() << x.transpose(), z.cross(x).transpose(), z.transpose();
  lamp.translation() = -lamp.linear() * light_in_rig;
  return lamp;
}

double LampPattern::factor(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.normalized();
  if (!(unit.dot(lamp_axis(parameters_)) > 0.0) && !parameters_.isZero()) return 0.0;
  return std::exp(log_pattern(parameters_, unit));
}

double LampPattern::sigma(const Eigen::Vector3d& direction) const {
  const Eigen::RowVector4d g = gradient(parameters_, direction.normalized());
  return factor(direction) * std::sqrt(std::max(0.0, g.dot(covariance_ * g.transpose())));
}

PatternFit fit_lamp_pattern(const std::vector<PatternSample>& samples, std::optional<int> parameters) {
  const PatternProblem problem(usable(samples));
  if (problem.samples().empty()) return {};
  constexpr std::array<std::array<bool, 4>, 4> kSteps{
      {{false, false, false, false}, {true, false, false, false}, {true, true, true, false}, {true, true, true, true}}};
  // The scale of the richest model: a poorer one's misfit must not excuse itself.
  State rich = start_state(problem);
  rich.p = expanded_pattern(problem);
  // Shrinking, so that a shadow across a part of the samples loses its hold step by step.
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    rich.converged = false;
    const double before = residual_scale(problem, rich);
    rich = problem.solve(kSteps[round < kRounds / 2 ? 2 : 3], rich, before);
    if (round > kRounds / 2 && residual_scale(problem, rich) > 0.99 * before) break;
  }
  const double scale = residual_scale(problem, rich);
  std::size_t chosen = 0;
  State best = problem.solve(kSteps[0], start_state(problem), scale);
  for (std::size_t k = 1; k < kSteps.size(); ++k) {
    State start = best;
    start.converged = false;
    if (chosen < 2) start.p = k == 1 ? Parameters(rich.p[0], 0.0, 0.0, 0.0) : expanded_pattern(problem);
    const State candidate = problem.solve(kSteps[k], start, scale);
    const bool wanted = parameters ? std::count(kSteps[k].begin(), kSteps[k].end(), true) <= *parameters
                                   : best.chi2 - candidate.chi2 >= kLeastGain * scale * scale;
    if (!wanted) continue;
    best = candidate;
    chosen = k;
  }
  return summary_of(problem, best, kSteps[chosen]);
}

PatternFit fit_lamp_pattern(const std::vector<PatternSample>& samples, const std::vector<double>& stray_shares) {
  PatternFit fit = fit_lamp_pattern(samples);
  std::vector<PatternSample> freed = samples;
  for (std::size_t i = 0; i < freed.size(); ++i) {
    const double whole = 1.0 + stray_shares[i];
    freed[i].radiance /= whole;
    freed[i].variance /= whole * whole;
  }
  // With the same parameters: one that is just no longer significant would else be missing as a whole.
  const Parameters off = fit_lamp_pattern(freed, fit.parameters).pattern.parameters() - fit.pattern.parameters();
  fit.pattern = LampPattern(fit.pattern.parameters(), fit.pattern.covariance() + off * off.transpose());
  return fit;
}

double irradiance_per_intensity(const LampPattern& pattern, const Eigen::Vector3d& position_in_lamp) {
  return pattern.factor(position_in_lamp) / position_in_lamp.squaredNorm();
}

}  // namespace lumitexel
