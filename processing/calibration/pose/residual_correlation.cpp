#include "processing/calibration/pose/residual_correlation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumitexel {
namespace {

constexpr std::size_t kBins = 24;
using RowsTogether = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // pairs of rows are what is read

// Pairs nearer than reach_m, found along one sorted axis; visit(i, j, bin) with i < j in that order.
template <class Visit>
void each_near_pair(const std::vector<Eigen::Vector3d>& x, double reach_m, const Visit& visit) {
  Eigen::Vector3d low = x.front(), high = x.front();
  for (const Eigen::Vector3d& p : x) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a][axis] < x[b][axis]; });
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size() && x[order[b]][axis] - x[order[a]][axis] < reach_m; ++b) {
      const double distance = (x[order[a]] - x[order[b]]).norm();
      if (distance < reach_m) visit(order[a], order[b], static_cast<std::size_t>(distance / reach_m * kBins));
    }
  }
}

std::vector<double> covariance_function(const WeightedResiduals& fit, double reach_m) {
  std::vector<double> sum(kBins, 0.0), weight(kBins, 0.0);
  each_near_pair(fit.x_in_mesh, reach_m, [&](std::size_t i, std::size_t j, std::size_t bin) {
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    const double w = fit.weight[a] * fit.weight[b];
    sum[bin] += w * fit.residual[a] * fit.residual[b];
    weight[bin] += w;
  });
  bool ended = false;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double mean = weight[bin] > 0.0 ? sum[bin] / weight[bin] : 0.0;
    ended = ended || (weight[bin] > 0.0 && mean <= 0.0);
    sum[bin] = ended ? 0.0 : mean;
  }
  return sum;
}

// Raises m to at least `least` in every direction.
Eigen::MatrixXd not_below(const Eigen::MatrixXd& m, const Eigen::MatrixXd& least) {
  const Eigen::VectorXd scale = least.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::MatrixXd unit = scale.cwiseInverse().asDiagonal() * least * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd regular = unit + 1e-12 * Eigen::MatrixXd::Identity(unit.rows(), unit.cols());
  const Eigen::LLT<Eigen::MatrixXd> root(regular);
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * m * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd half = root.matrixL().solve(scaled);
  const Eigen::MatrixXd relative = root.matrixL().solve(Eigen::MatrixXd(half.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (relative + relative.transpose()));
  const Eigen::MatrixXd raised = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::MatrixXd l = root.matrixL();
  return scale.asDiagonal() * (l * raised * l.transpose()) * scale.asDiagonal();
}

}  // namespace

FitCovariance correlated_scores(const WeightedResiduals& fit, double reach_m) {
  const Eigen::Index parameters = fit.jacobian.cols(), rows = fit.residual.size();
  FitCovariance result{Eigen::MatrixXd::Zero(parameters, parameters), 0.0, 0.0};
  if (rows == 0) return result;
  const double variance = (fit.weight.array() * fit.residual.array().square()).sum() / fit.weight.sum();
  const RowsTogether scores = fit.weight.asDiagonal() * fit.jacobian;
  const Eigen::MatrixXd alone = variance * (scores.transpose() * scores);
  const std::vector<double> correlated = covariance_function(fit, reach_m);
  // For each residual what its later neighbours contribute together, then one product.
  RowsTogether neighbours = RowsTogether::Zero(rows, parameters);
  double pairs = 0.0;
  each_near_pair(fit.x_in_mesh, reach_m, [&](std::size_t i, std::size_t j, std::size_t bin) {
    if (correlated[bin] <= 0.0) return;
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    neighbours.row(a) += correlated[bin] * scores.row(b);
    pairs += correlated[bin] * fit.weight[a] * fit.weight[b];
  });
  const Eigen::MatrixXd cross = scores.transpose() * neighbours;
  result.sigma = std::sqrt(variance);
  const double alone_sum = variance * fit.weight.squaredNorm();
  result.independent = fit.weight.sum() * fit.weight.sum() / fit.weight.squaredNorm() * alone_sum / (alone_sum + 2.0 * pairs);
  // The fit has followed part of what it is to be judged by; below twice as many residuals as parameters nothing is known.
  const double p = static_cast<double>(parameters);
  const double followed = result.independent / std::max(result.independent - p, 0.5 * p);
  result.meat = followed * not_below(alone + cross + cross.transpose(), alone);
  return result;
}

Eigen::MatrixXd sandwich(const Eigen::MatrixXd& information, const Eigen::MatrixXd& meat) {
  // To unit diagonal first: radians, metres and pixels differ by many orders of magnitude.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit);
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(1e-12).cwiseInverse();
  const Eigen::MatrixXd bread = scale.asDiagonal() * (eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose()) *
                                scale.asDiagonal();
  return bread * meat * bread;
}

}  // namespace lumitexel
