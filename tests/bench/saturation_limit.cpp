// What any estimator can reach at most where one exposure of a bracket saturates, in the normal limit.
//
// The light theta is in standard deviations of that exposure, over its limit. The exposure tells y ~ N(theta, 1) if y <
// 0, else only that y >= 0; the shorter ones together tell x ~ N(theta, others^2). The Fisher information of the pair
// is
//     1 / others^2 + Phi(z) - z phi(z) + phi(z)^2 / (1 - Phi(z)),   z = -theta,
// whose inverse is the Cramer-Rao bound. It is no bound of a single pixel's mean square error: the sample that came out
// below the limit knows much, the one above little, and the bound is that of their mean information. For any prior of
// theta the largest error over the bound, over all theta, is at least the prior's mean of it at the Bayes estimate
// (Wald); multiplicative weights find the prior for which that is most, and the estimate that attains it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "processing/image/censored_normal.h"
#include "tests/bench/machine.h"

namespace {

using Row = std::vector<double>;

double density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }
double distribution(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// A pixel's statistic is m, the mean of both samples by their weights, where y is known, and x where it is not.
struct Estimate {
  Row known, censored;  // at every value of the statistic
};

class Limit {
 public:
  explicit Limit(double others) : others_(others) {
    for (double theta = -10.0; theta < 14.05; theta += 0.1) thetas_.push_back(theta);
    for (double value = -30.0; value < 35.0; value += kStep) values_.push_back(value);
    const double mean = others / std::sqrt(1.0 + others * others), apart = std::sqrt(1.0 - mean * mean);
    for (const double theta : thetas_) {
      const double below = std::max(distribution(-theta), 1e-300), above = std::max(distribution(theta), 1e-300);
      const double information =
          theta > 8.0 ? 0.0 : below + theta * density(theta) + density(theta) * density(theta) / above;
      bounds_.push_back(1.0 / (1.0 / (others * others) + information));
      Row known, censored;
      for (const double value : values_) {
        known.push_back(density((value - theta) / mean) / mean * distribution(-value / apart) * kStep);
        censored.push_back(density((value - theta) / others) / others * above * kStep);
      }
      known_.push_back(known);
      censored_.push_back(censored);
    }
  }

  // hdr_merge.h: the mean where all is known, else the maximum of the likelihood.
  Estimate merged() const {
    Estimate estimate{values_, {}};
    for (const double x : values_) {
      double theta = x;
      for (int step = 0; step < 100; ++step) {
        const double h = lumitexel::log_cdf_slope(theta), held = 1.0 / (others_ * others_);
        theta += (held * (x - theta) + h) / (held + h * (h + theta));
      }
      estimate.censored.push_back(theta);
    }
    return estimate;
  }

  // Mean square error over the bound at every theta.
  Row risk(const Estimate& estimate) const {
    Row risks;
    for (std::size_t i = 0; i < thetas_.size(); ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < values_.size(); ++j) {
        sum += known_[i][j] * std::pow(estimate.known[j] - thetas_[i], 2) +
               censored_[i][j] * std::pow(estimate.censored[j] - thetas_[i], 2);
      }
      risks.push_back(sum / bounds_[i]);
    }
    return risks;
  }

  // The least mean of `risk` under this prior.
  Estimate bayes(const Row& prior) const { return {posterior_mean(prior, known_), posterior_mean(prior, censored_)}; }
  Row bias(const Estimate& estimate) const {
    Row biases;
    for (std::size_t i = 0; i < thetas_.size(); ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < values_.size(); ++j)
        sum += known_[i][j] * (estimate.known[j] - thetas_[i]) + censored_[i][j] * (estimate.censored[j] - thetas_[i]);
      biases.push_back(sum / std::sqrt(bounds_[i]));
    }
    return biases;
  }
  const Row& thetas() const { return thetas_; }

 private:
  static constexpr double kStep = 0.05;
  Row posterior_mean(const Row& prior, const std::vector<Row>& likelihood) const {
    Row weights(values_.size()), sums(values_.size());
    for (std::size_t i = 0; i < thetas_.size(); ++i) {
      for (std::size_t j = 0; j < values_.size(); ++j) {
        weights[j] += prior[i] / bounds_[i] * likelihood[i][j];
        sums[j] += prior[i] / bounds_[i] * likelihood[i][j] * thetas_[i];
      }
    }
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j] = weights[j] > 1e-290 ? sums[j] / weights[j] : values_[j];
    return sums;
  }

  double others_;
  Row thetas_, values_, bounds_;
  std::vector<Row> known_, censored_;
};

struct Minimax {
  double proven = 0.0;  // no estimator's largest risk is below
  Estimate best;        // its largest risk is the least found
  Row risks;
};

Minimax minimax(const Limit& limit, int rounds) {
  Row prior(limit.thetas().size(), 1.0 / static_cast<double>(limit.thetas().size()));
  Minimax result;
  double least = 1e300;
  for (int round = 0; round < rounds; ++round) {
    const Estimate estimate = limit.bayes(prior);
    const Row risks = limit.risk(estimate);
    double mean = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < prior.size(); ++i) mean += prior[i] * risks[i];
    result.proven = std::max(result.proven, mean);
    const double largest = *std::max_element(risks.begin(), risks.end());
    if (largest < least) result.best = estimate, result.risks = risks;
    least = std::min(least, largest);
    for (std::size_t i = 0; i < prior.size(); ++i) sum += prior[i] *= std::exp(risks[i] - mean);
    for (double& p : prior) p /= sum;
  }
  return result;
}

void print(const std::vector<double>& ratios, int rounds) {
  double information = 0.0;
  for (const double ratio : ratios) information += 1.0 / ratio;
  const Limit limit(1.0 / std::sqrt(information));
  const Estimate merged = limit.merged();
  const Row risks = limit.risk(merged), biases = limit.bias(merged);
  const Minimax best = minimax(limit, rounds);
  const Row best_biases = limit.bias(best.best);
  std::printf("shorter exposures at 1 /");
  for (const double ratio : ratios) std::printf(" %g", ratio);
  std::printf(": no estimator's largest error / bound is below %.4f (found %.4f); the merge's is %.3f\n",
              std::sqrt(best.proven), std::sqrt(*std::max_element(best.risks.begin(), best.risks.end())),
              std::sqrt(*std::max_element(risks.begin(), risks.end())));
  std::printf("%8s %8s %8s %8s %8s\n", "theta", "merge", "bias", "minimax", "bias");
  for (std::size_t i = 0; i < risks.size(); i += 20)
    std::printf("%8.1f %8.3f %8.3f %8.3f %8.3f\n", limit.thetas()[i], std::sqrt(risks[i]), biases[i],
                std::sqrt(best.risks[i]), best_biases[i]);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> ratios{8.0, 64.0};
  int rounds = 1500;
  CLI::App app{"The least largest error where an exposure saturates, over the Cramer-Rao bound"};
  app.add_option("--ratios", ratios, "of the saturating exposure to each shorter one");
  app.add_option("--rounds", rounds, "of the search for the worst prior")->check(CLI::Range(1, 100'000));
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", lumitexel::machine_line().c_str());
  print(ratios, rounds);
  return 0;
}
