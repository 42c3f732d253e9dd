#include "processing/calibration/lens/check_lens.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "drivers/error.h"
#include "processing/calibration/lens/chi_square.h"
#include "processing/calibration/lens/lens_start.h"

namespace lumitexel {
namespace {

constexpr double kOneInAHundred_z = 2.326;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

struct Stacked {
  Eigen::VectorXd residual;
  Eigen::MatrixXd slope;
};

Stacked stacked(const CameraModel& camera, const std::vector<BoardSighting>& sightings, double& rms_px) {
  Stacked all{Eigen::VectorXd(0), Eigen::MatrixXd(0, kLensParameters)};
  double squares = 0, points = 0;
  for (const BoardSighting& sighting : sightings) {
    constexpr std::size_t kLeastPoints = 6;
    if (sighting.points() < kLeastPoints) continue;
    const PlacedBoard board = place_board(camera, sighting);
    const PoseFreeResiduals free = pose_free_residuals(camera, board);
    const double rms = board_misfit(camera, board).rms_px, n = static_cast<double>(sighting.points());
    squares += n * rms * rms, points += n;
    const Eigen::Index before = all.residual.size();
    all.residual.conservativeResize(before + free.residual.size());
    all.residual.tail(free.residual.size()) = free.residual;
    all.slope.conservativeResize(before + free.residual.size(), kLensParameters);
    all.slope.bottomRows(free.residual.size()) = free.slope;
  }
  rms_px = points > 0 ? std::sqrt(squares / points) : 0.0;
  return all;
}

// The size of a change along `direction` that is seen 19 times in 20 at a false alarm rate of 1 in 100.
double detectable(const Eigen::MatrixXd& response, const Eigen::LDLT<Eigen::MatrixXd>& expected,
                  const LensVector& direction) {
  // A chi square of 8 degrees with this non-centrality passes its 99 % bound 19 times in 20.
  constexpr double kNonCentrality = 31.7;
  const Eigen::VectorXd shift = response * direction;
  const double power = shift.dot(expected.solve(shift));
  return power > 0.0 ? std::sqrt(kNonCentrality / power) : std::numeric_limits<double>::infinity();
}

}  // namespace

const char* to_string(LensVerdict verdict) {
  switch (verdict) {
    case LensVerdict::Holds:
      return "holds";
    case LensVerdict::Changed:
      return "changed";
    case LensVerdict::Unclear:
      return "unclear";
  }
  return "?";
}

LensCheck check_lens(const CameraModel& camera, const LensMatrix& covariance,
                     const std::vector<BoardSighting>& sightings) {
  if (!covariance.allFinite())
    throw BadInput("lens check", "a covariance that is not finite", "that of a usable calibration");
  LensCheck check;
  const Stacked all = stacked(camera, sightings, check.rms_px);
  const Eigen::Index rest = all.residual.size() - kLensParameters;
  if (rest < kLensParameters || !all.residual.allFinite()) {
    check.reason = "too few points found on the board: photograph it whole, tilted and large";
    return check;
  }
  // In units of what each parameter does, so that the singular values compare.
  const LensVector scale =
      all.slope.colwise().norm().cwiseMax(std::numeric_limits<double>::min()).cwiseInverse().transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(all.slope * scale.asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  constexpr double kRounding = 1e-7;
  const Eigen::Index rank = (svd.singularValues().array() > kRounding * svd.singularValues()[0]).count();
  const Eigen::VectorXd u = svd.matrixU().leftCols(rank).transpose() * all.residual;
  const double left_over = all.residual.squaredNorm() - u.squaredNorm();
  const double degrees_left = static_cast<double>(all.residual.size() - rank);
  check.board_reduced_chi2 = left_over / degrees_left;
  const double unit = std::max(1.0, check.board_reduced_chi2);
  const Eigen::MatrixXd response = svd.singularValues().head(rank).asDiagonal() *
                                   svd.matrixV().leftCols(rank).transpose() * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd expected =
      unit * Eigen::MatrixXd::Identity(rank, rank) + response * covariance * response.transpose();
  const Eigen::LDLT<Eigen::MatrixXd> factor(expected);
  check.chi2 = u.dot(factor.solve(u));
  check.degrees = static_cast<double>(rank);
  check.bound = chi2_bound(check.degrees, kOneInAHundred_z);
  LensVector focal = LensVector::Zero(), principal = LensVector::Zero();
  focal[0] = camera.focal_x_px, focal[1] = camera.focal_y_px, principal[2] = 1.0;
  check.detectable_focal = detectable(response, factor, focal);
  check.detectable_principal_px = detectable(response, factor, principal);
  constexpr double kMostScatter = 9.0;  // three times the stated sigma: no judgement on the lens
  if (check.board_reduced_chi2 > kMostScatter) {
    check.reason = "the board's points scatter " + number(std::sqrt(check.board_reduced_chi2)) +
                   " times as much as they should with any lens: bent, moved, blurred or misread";
    return check;
  }
  check.verdict = check.chi2 > check.bound ? LensVerdict::Changed : LensVerdict::Holds;
  check.reason = "chi square " + number(check.chi2) + " of " + number(check.degrees) + ", bound " +
                 number(check.bound) + "; would notice " + number(100.0 * check.detectable_focal) +
                 " % of focal length, " + number(check.detectable_principal_px) + " px of principal point";
  return check;
}

}  // namespace lumitexel
