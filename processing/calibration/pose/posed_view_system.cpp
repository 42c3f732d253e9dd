#include "processing/calibration/pose/posed_view_system.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

namespace lumitexel {
namespace {

// Poses that are off by more are no start.
constexpr double kBroadTurn_rad = 0.1, kBroadShift_m = 0.1;
constexpr double kLeastTurn_rad = 1e-8, kLeastShift_m = 1e-9;

constexpr std::array<std::size_t, 6> kKind{0, 0, 0, 1, 1, 2};  // turn, across, along

std::array<double, 3> squares(const PoseSpread& s) {
  return {s.turn_rad * s.turn_rad, s.across_m * s.across_m, s.along_m * s.along_m};
}

PoseSpread spread_from(const std::array<double, 3>& squares) {
  return {std::sqrt(squares[0]), std::sqrt(squares[1]), std::sqrt(squares[2])};
}

PoseSpread not_too_small(const PoseSpread& s) {
  return {std::max(s.turn_rad, kLeastTurn_rad), std::max(s.across_m, kLeastShift_m), std::max(s.along_m, kLeastShift_m)};
}

// Turns and shifts differ in unit, so to unit diagonal first.
PoseCovariance inverse_of(const PoseCovariance& m) {
  const PoseStep scale = m.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const PoseCovariance unit = scale.asDiagonal() * m * scale.asDiagonal();
  return scale.asDiagonal() * unit.ldlt().solve(PoseCovariance::Identity()) * scale.asDiagonal();
}

}  // namespace

PoseStep PoseSpread::information() const {
  const std::array<double, 3> s = squares(*this);
  PoseStep diagonal;
  for (std::size_t c = 0; c < 6; ++c) diagonal[static_cast<Eigen::Index>(c)] = 1.0 / s[kKind[c]];
  return diagonal;
}

PosedViewSystem::PosedViewSystem(std::size_t views, Eigen::Index shared_unknowns)
    : own(views, PoseCovariance::Zero()), mixed(views, Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, shared_unknowns)),
      score(views, PoseStep::Zero()), shared(Eigen::MatrixXd::Zero(shared_unknowns, shared_unknowns)),
      shared_score(Eigen::VectorXd::Zero(shared_unknowns)) {}

PosedViewSolution solve(const PosedViewSystem& system, const PoseSpread& spread, const std::vector<PoseStep>& from_given) {
  const PoseStep prior = spread.information();
  PosedViewSolution solution;
  Eigen::MatrixXd reduced = system.shared;
  Eigen::VectorXd right = system.shared_score;
  std::vector<PoseCovariance> alone;
  for (std::size_t v = 0; v < system.own.size(); ++v) {
    PoseCovariance information = system.own[v];
    information.diagonal() += prior;
    alone.push_back(inverse_of(information));
    const PoseStep score = system.score[v] - prior.cwiseProduct(from_given[v]);
    reduced -= system.mixed[v].transpose() * alone[v] * system.mixed[v];
    right -= system.mixed[v].transpose() * alone[v] * score;
  }
  const Eigen::MatrixXd shared_covariance =
      reduced.ldlt().solve(Eigen::MatrixXd::Identity(reduced.rows(), reduced.cols()));
  solution.shared_step = shared_covariance * right;
  for (std::size_t v = 0; v < system.own.size(); ++v) {
    const PoseStep score = system.score[v] - prior.cwiseProduct(from_given[v]);
    const Eigen::Matrix<double, 6, Eigen::Dynamic> by_shared = alone[v] * system.mixed[v];
    solution.steps.push_back(alone[v] * score - by_shared * solution.shared_step);
    solution.covariance.push_back(alone[v] + by_shared * shared_covariance * by_shared.transpose());
  }
  return solution;
}

PoseSpread likeliest_spread(const PosedViewSystem& system, PoseSpread start, const std::vector<PoseStep>& from_given, int rounds) {
  PoseSpread spread = not_too_small(start);
  for (int round = 0; round < rounds; ++round) {
    const PosedViewSolution solution = solve(system, spread, from_given);
    std::array<double, 3> sum{}, count{};
    for (std::size_t v = 0; v < system.own.size(); ++v) {
      if (system.own[v].isZero()) continue;
      const PoseStep off = from_given[v] + solution.steps[v];
      for (std::size_t c = 0; c < 6; ++c) {
        const auto i = static_cast<Eigen::Index>(c);
        sum[kKind[c]] += off[i] * off[i] + solution.covariance[v](i, i);
        count[kKind[c]] += 1.0;
      }
    }
    if (count[0] == 0.0) return spread;
    for (std::size_t k = 0; k < 3; ++k) sum[k] /= count[k];
    spread = not_too_small(spread_from(sum));
  }
  return spread;
}

PoseSpread upper_spread(const PosedViewSystem& system, const PoseSpread& spread) {
  const PoseStep broad = PoseSpread{kBroadTurn_rad, kBroadShift_m, kBroadShift_m}.information();
  std::array<double, 3> squared = squares(spread), information{};
  for (const PoseCovariance& own : system.own) {
    if (own.isZero()) continue;
    PoseCovariance alone = own;
    alone.diagonal() += broad;
    const PoseCovariance covariance = inverse_of(alone);
    for (std::size_t c = 0; c < 6; ++c) {
      const auto i = static_cast<Eigen::Index>(c);
      information[kKind[c]] += 0.5 / std::pow(squared[kKind[c]] + covariance(i, i), 2);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (information[k] > 0.0) squared[k] += 1.0 / std::sqrt(information[k]);
  }
  return spread_from(squared);
}

}  // namespace lumitexel
