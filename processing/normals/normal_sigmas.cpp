#include "processing/normals/normal_sigmas.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <random>

#include "processing/normals/normal_system.h"

namespace lumitexel {
namespace {

constexpr double kLeastInformation = 1e-6;  // per square radian, so that a lumitexel without samples has a factor, too

using Draw = std::function<double()>;

// Random numbers with the samples' information as covariance.
Steps samples_right(const LinearSystem& system, const Draw& draw) {
  Steps right;
  for (const Eigen::Matrix2d& data : system.data) {
    const Eigen::LLT<Eigen::Matrix2d> factor(data + kLeastInformation * Eigen::Matrix2d::Identity());
    right.push_back(factor.matrixL() * Eigen::Vector2d(draw(), draw()));
  }
  return right;
}

// Random numbers with the prior's information as covariance.
Steps prior_right(const NormalProblem& problem, const Loops& loops, const LinearSystem& system, const NormalPrior& prior, const Draw& draw) {
  const std::size_t n = problem.lumitexels.size();
  const double coarse = 1.0 / prior.coarse_sigma_rad;
  std::vector<Eigen::Vector3d> pull(n, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    pull[i] += coarse * Eigen::Vector3d(draw(), draw(), draw());  // in world: the same draw whatever the frame
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      if (j < i) continue;
      const Eigen::Vector3d both = std::sqrt(system.link[k]) * Eigen::Vector3d(draw(), draw(), draw());
      pull[i] += both;
      pull[j] -= both;
    }
  }
  for (std::size_t l = 0; l < loops.sides.size(); ++l) {
    const double value = draw() * std::sqrt(system.curl_weight);
    for (std::size_t k = 0; k < 4; ++k) pull[problem.neighbours.loop[l][k]] += value * loops.sides[l][k];
  }
  Steps right(n);
  for (std::size_t i = 0; i < n; ++i) right[i] = system.frame[i].transpose() * pull[i];
  return right;
}

// Rms over draws and axes of what the system solves right sides to; each solution is shown to `see`.
template <typename RightSide, typename See>
std::vector<float> drawn_sigmas(const NormalProblem& problem, const Loops& loops, LinearSystem& system, std::uint64_t first_seed,
                                RightSide right_side, See see) {
  std::vector<double> squares(problem.lumitexels.size(), 0.0);
  for (std::uint64_t k = 0; k < kSigmaDraws; ++k) {
    std::mt19937_64 random(first_seed + k);
    std::normal_distribution<double> normal;
    system.right = right_side([&] { return normal(random); });
    const Steps steps = solve(problem, loops, system);
    for (std::size_t i = 0; i < steps.size(); ++i) squares[i] += steps[i].squaredNorm() / (2.0 * kSigmaDraws);
    see(steps);
  }
  std::vector<float> sigmas(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i) sigmas[i] = static_cast<float>(std::sqrt(squares[i]));
  return sigmas;
}

PriorDraw in_world(const LinearSystem& system, const Steps& steps) {
  PriorDraw draw;
  for (std::size_t i = 0; i < steps.size(); ++i) draw.push_back(system.frame[i] * steps[i]);
  return draw;
}

}  // namespace

NormalSigmas normal_sigmas(const NormalProblem& problem, const NormalField& field, const NormalPrior& prior, std::vector<PriorDraw>* draws) {
  const Loops loops(problem);
  LinearSystem system = linearise(problem, loops, field, prior);
  const auto of_samples = [&](const Draw& draw) { return samples_right(system, draw); };
  const auto of_prior = [&](const Draw& draw) { return prior_right(problem, loops, system, prior, draw); };
  NormalSigmas sigmas;
  sigmas.samples_rad = drawn_sigmas(problem, loops, system, 0, of_samples, [](const Steps&) {});
  sigmas.prior_rad = drawn_sigmas(problem, loops, system, kSigmaDraws, of_prior, [&](const Steps& steps) {
    if (draws != nullptr) draws->push_back(in_world(system, steps));
  });
  return sigmas;
}

}  // namespace lumitexel
