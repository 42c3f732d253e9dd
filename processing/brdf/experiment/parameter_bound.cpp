#include "processing/brdf/experiment/parameter_bound.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "processing/brdf/experiment/dice.h"
#include "processing/brdf/experiment/mixture_score.h"
#include "processing/brdf/normal_equations.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr int kDraws = 2;  // of the noise, for each lumitexel as each material
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

std::vector<SampleValues> with_noise(const PredictedSamples& truth, double relative_sigma, Dice& dice) {
  std::vector<SampleValues> values = truth.value;
  for (SampleValues& value : values) {
    for (Eigen::Index c = 0; c < value.size(); ++c) value[c] *= 1.0 + relative_sigma * dice.normal();
  }
  return values;
}

// Of the whole mixture: what there would be to know with labels, and what of it is not there without them.
struct Information {
  Eigen::MatrixXd with_labels, missing;
};

Information& operator+=(Information& a, const Information& b) {
  a.with_labels += b.with_labels;
  a.missing += b.missing;
  return a;
}

// One lumitexel as material k, which it is with the probability `share`.
void add_with_labels(const PredictedSamples& material, Eigen::Index first, double share, double relative_sigma, Eigen::MatrixXd& sum) {
  const double of_a_sample = share * (1.0 / (relative_sigma * relative_sigma) + 2.0);  // 2: the noise's size tells, too
  for (const SampleSlopes& slope : material.relative_slope) {
    sum.block(first, first, slope.cols(), slope.cols()) += of_a_sample * slope.transpose() * slope;
  }
}

void add_missing(const MixtureScore& score, double weight, Eigen::MatrixXd& sum) {
  const Eigen::VectorXd mean = score.slope();
  for (std::size_t k = 0; k < score.probability.size(); ++k) {
    const double share = weight * score.probability[k];
    if (share < 1e-12) continue;  // most: a highlight tells its material
    const Eigen::VectorXd off = score.if_known.col(static_cast<Eigen::Index>(k)) - mean;
    sum.noalias() += share * off * off.transpose();
  }
}

// Whose a lumitexel is says, of the shares, what a draw from a multinomial distribution does.
void add_of_shares(const std::vector<double>& shares, double lumitexels, Eigen::MatrixXd& sum) {
  const auto others = static_cast<Eigen::Index>(shares.size()) - 1, first = sum.rows() - others;
  sum.block(first, first, others, others).array() += lumitexels / shares.back();
  for (Eigen::Index k = 0; k < others; ++k) sum(first + k, first + k) += lumitexels / shares[static_cast<std::size_t>(k)];
}

Information information(const FiveMaterials& world, const BrdfParameters& layout) {
  const std::vector<double> shares = material_shares(world);
  const auto count = static_cast<Eigen::Index>(shares.size()), own = static_cast<Eigen::Index>(layout.size());
  std::vector<BrdfSlopes> models;
  for (const Brdf& brdf : world.truth) models.emplace_back(layout, layout.from(brdf));
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(count * own + count - 1, count * own + count - 1);
  Information sum = ordered_sum(world.label.size(), Information{zero, zero}, [&](std::size_t i, Information& block) {
    std::vector<PredictedSamples> materials;
    for (const BrdfSlopes& model : models) materials.push_back(predicted_samples(model, world.observations.of(i)));
    Dice dice(kDrawSeed + world.seed * world.label.size() + i);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      add_with_labels(materials[k], static_cast<Eigen::Index>(k) * own, shares[k], world.relative_sigma, block.with_labels);
      for (int draw = 0; draw < kDraws; ++draw) {
        const auto values = with_noise(materials[k], world.relative_sigma, dice);
        add_missing(mixture_score(materials, shares, world.relative_sigma, values), shares[k] / kDraws, block.missing);
      }
    }
  });
  add_of_shares(shares, static_cast<double>(world.label.size()), sum.with_labels);
  return sum;
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
  const Information all = information(world, layout);
  const Eigen::MatrixXd with = inverse(all.with_labels), without = inverse(all.with_labels - all.missing);
  std::vector<MaterialBound> bounds = bound_with_labels(world);
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Eigen::Index first = static_cast<Eigen::Index>(k) * layout.size();
    const MaterialBound told = bound_in(with, layout, first), untold = bound_in(without, layout, first);
    bounds[k].log_exponent *= untold.log_exponent / told.log_exponent;
    for (std::size_t c = 0; c < 3; ++c) bounds[k].diffuse[c] *= untold.diffuse[c] / told.diffuse[c];
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
