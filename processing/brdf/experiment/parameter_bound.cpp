#include "processing/brdf/experiment/parameter_bound.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/brdf/experiment/dice.h"
#include "processing/brdf/normal_equations.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr int kDraws = 8;  // of noise and label a lumitexel: 1,300 of the rarest material's 167, for its eight parameters
constexpr std::uint64_t kDrawSeed = 20031101;

BrdfParameters one_shape(const FiveMaterials& world) {
  const BrdfFamily family = world.truth[0].family;
  return BrdfParameters(family, 3, true, {widest_bounds(family)});
}

MaterialBound bound_in(const Eigen::MatrixXd& covariance, const BrdfParameters& layout, Eigen::Index first) {
  const auto sigma = [&](int parameter) { return std::sqrt(covariance(first + parameter, first + parameter)); };
  return {sigma(layout.log_shape(0, 0)), {sigma(layout.diffuse(0)), sigma(layout.diffuse(1)), sigma(layout.diffuse(2))}};
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& information) {
  return information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
}

// One lumitexel's geometries under one material: all that does not depend on what was measured.
struct Predictions {
  std::vector<SampleValues> value;
  std::vector<SampleSlopes> relative_slope;  // of ln value, a row a channel
};

Predictions predictions(const BrdfSlopes& model, std::span<const Observation> samples) {
  Predictions result{std::vector<SampleValues>(samples.size()), std::vector<SampleSlopes>(samples.size())};
  for (std::size_t s = 0; s < samples.size(); ++s) {
    model.predict(samples[s].geometry, result.value[s], result.relative_slope[s]);
    for (int c = 0; c < 3; ++c) result.relative_slope[s].row(c) /= result.value[s][c];
  }
  return result;
}

std::vector<SampleValues> measured(const Predictions& truth, double relative_sigma, Dice& dice) {
  std::vector<SampleValues> values = truth.value;
  for (SampleValues& value : values) {
    for (int c = 0; c < 3; ++c) value[c] *= 1.0 + relative_sigma * dice.normal();
  }
  return values;
}

// ln p of the samples under one material up to a constant, and its slope (the noise's size, which grows with the prediction, tells a little, too).
double log_likelihood(const Predictions& material, const std::vector<SampleValues>& values, double relative_sigma, Eigen::VectorXd& slope) {
  double sum = 0.0;
  slope.setZero();
  for (std::size_t s = 0; s < values.size(); ++s) {
    for (int c = 0; c < 3; ++c) {
      const double ratio = values[s][c] / material.value[s][c], off = (ratio - 1.0) / relative_sigma;
      sum -= std::log(material.value[s][c]) + 0.5 * off * off;
      slope += (ratio * off / relative_sigma - 1.0) * material.relative_slope[s].row(c).transpose();
    }
  }
  return sum;
}

int drawn_label(const std::vector<double>& shares, Dice& dice) {
  double left = dice.uniform(0.0, 1.0);
  int label = 0;
  for (; label + 1 < static_cast<int>(shares.size()); ++label) {
    left -= shares[static_cast<std::size_t>(label)];
    if (left < 0.0) break;
  }
  return label;
}

// The slope of the mixture's ln p for one measured lumitexel: all materials' parameters, then all shares but the last.
Eigen::VectorXd mixture_score(const std::vector<Predictions>& materials, const std::vector<SampleValues>& values,
                              const std::vector<double>& shares, double relative_sigma, int parameters) {
  const auto count = static_cast<int>(materials.size());
  std::vector<double> logs(materials.size());
  std::vector<Eigen::VectorXd> slopes(materials.size(), Eigen::VectorXd(parameters));
  for (std::size_t k = 0; k < materials.size(); ++k) {
    logs[k] = std::log(shares[k]) + log_likelihood(materials[k], values, relative_sigma, slopes[k]);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double total = 0.0;
  for (double& log : logs) total += (log = std::exp(log - most));
  Eigen::VectorXd score(count * parameters + count - 1);
  for (int k = 0; k < count; ++k) score.segment(k * parameters, parameters) = logs[static_cast<std::size_t>(k)] / total * slopes[static_cast<std::size_t>(k)];
  const double last = logs.back() / total / shares.back();
  for (int k = 0; k + 1 < count; ++k) {
    score[count * parameters + k] = logs[static_cast<std::size_t>(k)] / total / shares[static_cast<std::size_t>(k)] - last;
  }
  return score;
}

std::vector<double> shares_of(const FiveMaterials& world) {
  std::vector<double> shares(world.truth.size(), 0.0);
  for (const int label : world.label) shares[static_cast<std::size_t>(label)] += 1.0 / static_cast<double>(world.label.size());
  return shares;
}

}  // namespace

std::vector<MaterialBound> bound_with_labels(const FiveMaterials& world) {
  const BrdfParameters layout = one_shape(world);
  ErrorModel error(world.relative_sigma, 1e-12);
  error.freedom = ErrorModel::kGaussian;
  std::vector<MaterialBound> bounds;
  for (std::size_t k = 0; k < world.truth.size(); ++k) {
    std::vector<FitSample> samples;
    for (std::size_t i = 0; i < world.label.size(); ++i) {
      if (world.label[i] != static_cast<int>(k)) continue;
      for (const Observation& sample : world.observations.of(i)) samples.push_back({&sample, 1.0, static_cast<std::uint32_t>(i)});
    }
    BrdfProblem problem(samples, layout, error, false);
    const Eigen::VectorXd at = layout.from(world.truth[k]);
    problem.reweight(at);
    bounds.push_back(bound_in(inverse(problem.linearise(at).matrix), layout, 0));
  }
  return bounds;
}

std::vector<MaterialBound> bound_without_labels(const FiveMaterials& world) {
  const BrdfParameters layout = one_shape(world);
  const std::vector<double> shares = shares_of(world);
  std::vector<BrdfSlopes> models;
  for (const Brdf& brdf : world.truth) models.emplace_back(layout, layout.from(brdf));
  const auto unknowns = static_cast<Eigen::Index>(models.size()) * layout.size() + static_cast<Eigen::Index>(models.size()) - 1;
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(unknowns, unknowns);
  const Eigen::MatrixXd sum = ordered_sum(world.label.size(), zero, [&](std::size_t i, Eigen::MatrixXd& information) {
    std::vector<Predictions> materials;
    for (const BrdfSlopes& model : models) materials.push_back(predictions(model, world.observations.of(i)));
    Dice dice(kDrawSeed + i);
    for (int draw = 0; draw < kDraws; ++draw) {
      const auto label = static_cast<std::size_t>(drawn_label(shares, dice));
      const std::vector<SampleValues> values = measured(materials[label], world.relative_sigma, dice);
      const Eigen::VectorXd score = mixture_score(materials, values, shares, world.relative_sigma, layout.size());
      information.noalias() += score * score.transpose() / kDraws;
    }
  });
  const Eigen::MatrixXd covariance = inverse(sum);
  std::vector<MaterialBound> bounds;
  for (std::size_t k = 0; k < world.truth.size(); ++k) {
    bounds.push_back(bound_in(covariance, layout, static_cast<Eigen::Index>(k) * layout.size()));
  }
  return bounds;
}

double chance_within(double share, const std::vector<MaterialBound>& bound, const std::vector<Brdf>& truth) {
  const auto within = [&](double relative_sigma) { return std::erf(share / relative_sigma / std::numbers::sqrt2); };
  double chance = 1.0;
  for (std::size_t k = 0; k < bound.size(); ++k) {
    chance *= within(bound[k].log_exponent);
    for (std::size_t c = 0; c < 3; ++c) chance *= within(bound[k].diffuse[c] / truth[k].diffuse[c]);
  }
  return chance;
}

}  // namespace lumitexel
