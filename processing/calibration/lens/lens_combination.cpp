#include "processing/calibration/lens/lens_combination.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "processing/calibration/lens/chi_square.h"
#include "processing/calibration/lens/lens_information.h"

namespace lumitexel {
namespace {

constexpr LensMask kAll{true, true, true, true, true, true, true, true};
constexpr int kMostRounds = 6;
constexpr double kOneInAMillion_z = 4.75;

// By way of a unit diagonal: parameters differ by ten orders of magnitude.
LensMatrix inverse(const LensMatrix& matrix) {
  const LensVector scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const LensMatrix unit = scale.asDiagonal() * matrix * scale.asDiagonal();
  return scale.asDiagonal() * unit.llt().solve(LensMatrix::Identity()) * scale.asDiagonal();
}

double unit_of(const LensInformation& boards) {
  return std::max(1.0, boards.chi2 / std::max(1.0, boards.degrees - kLensParameters));
}

}  // namespace

LensPull pull_of(const LensPrior& prior, double unit_chi2) {
  return {lens_vector(prior.camera), unit_chi2 * inverse(prior.covariance)};
}

CombinedLens combine_with_prior(CameraModel& camera, std::vector<PlacedBoard>& boards, const LensPrior& prior) {
  CombinedLens combined;
  LensPrior wide = prior;
  double unit = 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    combined.converged = refine_boards(camera, kAll, boards, pull_of(wide, unit));
    const LensInformation information = lens_information(camera, boards);
    const double last_unit = unit;
    unit = unit_of(information);
    const LensMatrix known = pull_of(wide).information;
    combined.covariance = inverse(information.matrix / unit + known);
    const LensVector off = lens_vector(camera) - lens_vector(prior.camera);
    const double contradiction = off.dot(known * off);
    if (contradiction > chi2_bound(kLensParameters, kOneInAMillion_z)) {
      const double factor = contradiction / kLensParameters;
      wide.covariance *= factor;
      combined.widened *= std::sqrt(factor);
    } else if (unit < 1.1 * last_unit && last_unit < 1.1 * unit) {
      break;
    }
  }
  return combined;
}

}  // namespace lumitexel
