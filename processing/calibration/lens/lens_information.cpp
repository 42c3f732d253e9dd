#include "processing/calibration/lens/lens_information.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

std::vector<Eigen::Index> indices(const LensMask& mask, bool wanted) {
  std::vector<Eigen::Index> result;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == wanted) result.push_back(static_cast<Eigen::Index>(i));
  }
  return result;
}

// The increase of chi square if the parameters outside `free` were zero and the others followed.
double cost_without(const LensVector& lens, const LensMatrix& information, const LensMask& free) {
  const auto kept = indices(free, true), dropped = indices(free, false);
  if (dropped.empty()) return 0.0;
  const LensVector scale = information.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt();
  const LensMatrix unit = scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd value = (scale.asDiagonal() * lens)(dropped);
  const Eigen::MatrixXd kk = unit(kept, kept), kd = unit(kept, dropped), dd = unit(dropped, dropped);
  const Eigen::MatrixXd left = dd - kd.transpose() * kk.completeOrthogonalDecomposition().solve(kd);
  return value.dot(left * value);
}

}  // namespace

LensInformation lens_information(const CameraModel& camera, const std::vector<PlacedBoard>& boards) {
  LensInformation information;
  for (const PlacedBoard& board : boards) {
    const PoseFreeResiduals free = pose_free_residuals(camera, board);
    information.matrix += free.slope.transpose() * free.slope;
    information.chi2 += free.residual.squaredNorm();
    information.degrees += static_cast<double>(free.residual.size());
  }
  return information;
}

LensMask chosen_terms(const LensVector& lens, const LensInformation& full) {
  const double unit = std::max(1.0, full.chi2 / std::max(1.0, full.degrees - kLensParameters));
  const double price = std::log(std::max(2.0, full.degrees));
  LensMask best{};
  double least = std::numeric_limits<double>::infinity();
  for (const bool tangential : {false, true}) {
    for (const int radial : {0, 1, 2}) {
      const LensMask terms{true, true, true, true, radial > 0, radial > 1, tangential, tangential};
      const double criterion = cost_without(lens, full.matrix, terms) / unit + price * (radial + (tangential ? 2 : 0));
      if (criterion < least) least = criterion, best = terms;
    }
  }
  return best;
}

std::optional<LensMatrix> lens_covariance(const LensInformation& information, const LensMask& free) {
  const auto kept = indices(free, true);
  const Eigen::MatrixXd matrix = information.matrix(kept, kept);
  if (!matrix.allFinite() || !(matrix.diagonal().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * matrix * scale.asDiagonal());
  constexpr double kRounding = 1e-13;
  if (!(solver.eigenvalues().minCoeff() > kRounding)) return std::nullopt;
  const double spare = information.degrees - static_cast<double>(kept.size());
  if (spare < 1.0) return std::nullopt;
  const Eigen::MatrixXd unit =
      solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  LensMatrix covariance = LensMatrix::Zero();
  covariance(kept, kept) = std::max(1.0, information.chi2 / spare) * (scale.asDiagonal() * unit * scale.asDiagonal());
  return covariance;
}

}  // namespace lumitexel
