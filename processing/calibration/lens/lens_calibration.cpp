#include "processing/calibration/lens/lens_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "drivers/error.h"
#include "processing/calibration/lens/chi_square.h"
#include "processing/calibration/lens/lens_combination.h"
#include "processing/calibration/lens/lens_information.h"
#include "processing/calibration/lens/lens_start.h"

namespace lumitexel {
namespace {

constexpr LensMask kFocalOnly{true, true, false, false, false, false, false, false};
constexpr LensMask kRadial{true, true, true, true, true, false, false, false};
constexpr LensMask kAll{true, true, true, true, true, true, true, true};

std::string number(double value, const char* format = "%.3g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void check(int width_px, int height_px, const std::vector<BoardSighting>& sightings) {
  if (width_px < 1 || height_px < 1)
    throw BadInput("lens calibration", std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels",
                   "the picture's size");
  for (const BoardSighting& sighting : sightings) {
    for (const Landmark& landmark : sighting.landmarks) {
      const auto n = static_cast<Eigen::Index>(2 * landmark.pixels.size());
      bool finite = landmark.x_in_board.size() == landmark.pixels.size() && landmark.covariance_px2.rows() == n &&
                    landmark.covariance_px2.cols() == n && n > 0;
      for (std::size_t i = 0; finite && i < landmark.pixels.size(); ++i)
        finite =
            landmark.pixels[i].allFinite() && landmark.x_in_board[i].allFinite() && landmark.x_in_board[i].z() == 0.0;
      if (!finite || Eigen::LLT<Eigen::MatrixXd>(landmark.covariance_px2).info() != Eigen::Success)
        throw BadInput("lens calibration, board " + sighting.name, "a landmark that is not finite",
                       "as many pixels as points of the plane z = 0, and a positive definite covariance of them");
    }
  }
}

std::string unusable(const BoardSighting& sighting) {
  constexpr std::size_t kLeastPoints = 6;
  if (sighting.points() < kLeastPoints)
    return std::to_string(sighting.points()) + " points found, at least " + std::to_string(kLeastPoints) + " needed";
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Landmark& l : sighting.landmarks) {
    for (const Eigen::Vector3d& x : l.x_in_board) mean += x.head<2>() / static_cast<double>(sighting.points());
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Landmark& l : sighting.landmarks) {
    for (const Eigen::Vector3d& x : l.x_in_board) spread += (x.head<2>() - mean) * (x.head<2>() - mean).transpose();
  }
  const Eigen::Vector2d axes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(spread)).eigenvalues();  // of any size: compiled once
  constexpr double kThin = 1e-4;  // squared: a hundredth as broad as long
  return axes[0] > kThin * axes[1] ? "" : "its points lie on one line";
}

double degrees_of(const PlacedBoard& board) {
  return std::max(1.0, 2.0 * static_cast<double>(board.sighting.points()) - 6.0);
}

// The boards under work; `place` is their index among the sightings given.
struct Boards {
  std::vector<PlacedBoard> placed;
  std::vector<std::size_t> place;
};

void replace_poorly_placed(const CameraModel& camera, Boards& boards) {
  constexpr double kPoor = 1.5;  // reduced chi square; a pose tilted the wrong way is far above
  for (PlacedBoard& board : boards.placed) {
    const double now = board_misfit(camera, board).chi2;
    if (now < kPoor * degrees_of(board)) continue;
    const PlacedBoard again = place_board(camera, board.sighting);
    if (board_misfit(camera, again).chi2 < now) board = again;
  }
}

bool fit_all_terms(CameraModel& camera, Boards& boards, const std::optional<LensPull>& pull) {
  for (const LensMask& free : {kFocalOnly, kRadial, kAll}) refine_boards(camera, free, boards.placed, pull);
  replace_poorly_placed(camera, boards);
  return refine_boards(camera, kAll, boards.placed, pull);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Verdict {
  bool fits;
  std::string reason;
};

Verdict verdict_on(const CameraModel& camera, const PlacedBoard& board, double typical_chi2) {
  constexpr double kOneInAMillion_z = 4.75, kMedians = 9.0;
  const BoardMisfit misfit = board_misfit(camera, board);
  const double degrees = degrees_of(board), typical = std::max(1.0, typical_chi2);
  const bool fits = misfit.chi2 <= std::max(chi2_bound(degrees, kOneInAMillion_z), kMedians * typical * degrees);
  return {fits, fits ? ""
                     : "does not fit: RMS " + number(misfit.rms_px) + " px, " +
                           number(std::sqrt(misfit.chi2 / degrees / typical)) +
                           " times what is usual for its corners: bent, moved, blurred or misread"};
}

double typical_chi2(const CameraModel& camera, const Boards& boards) {
  std::vector<double> values;
  for (const PlacedBoard& board : boards.placed) values.push_back(board_misfit(camera, board).chi2 / degrees_of(board));
  return median(std::move(values));
}

// Takes out the worst board that does not fit, fits again, until all fit. The worst alone, because it spoils others.
bool reject_misfits(CameraModel& camera, Boards& boards, const std::optional<LensPull>& pull, LensCalibration& result) {
  constexpr std::size_t kFewestToJudge = 3;
  bool converged = true;
  while (boards.placed.size() > kFewestToJudge) {
    const double typical = typical_chi2(camera, boards);
    std::size_t worst = 0;
    double most = 0;
    for (std::size_t b = 0; b < boards.placed.size(); ++b) {
      const double chi2 = board_misfit(camera, boards.placed[b]).chi2 / degrees_of(boards.placed[b]);
      if (chi2 > most) most = chi2, worst = b;
    }
    const Verdict verdict = verdict_on(camera, boards.placed[worst], typical);
    if (verdict.fits) break;
    result.boards[boards.place[worst]].rejected = verdict.reason;
    boards.placed.erase(boards.placed.begin() + static_cast<std::ptrdiff_t>(worst));
    boards.place.erase(boards.place.begin() + static_cast<std::ptrdiff_t>(worst));
    converged = fit_all_terms(camera, boards, pull);
  }
  return converged;
}

// Greatest angle between the normals of two boards.
double tilt_spread_deg(const Boards& boards) {
  double least = 1.0;
  for (const PlacedBoard& a : boards.placed) {
    for (const PlacedBoard& b : boards.placed)
      least = std::min(least, a.camera_from_board.linear().col(2).dot(b.camera_from_board.linear().col(2)));
  }
  return std::acos(std::clamp(least, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

std::string undetermined(const LensCalibration& result, const std::optional<LensMatrix>& covariance,
                         const Boards& boards) {
  constexpr double kWorstFocal = 0.02, kParallel_deg = 10.0;
  double relative = std::numeric_limits<double>::infinity();
  if (covariance)
    relative = std::max(std::sqrt((*covariance)(0, 0)) / result.camera.focal_x_px,
                        std::sqrt((*covariance)(1, 1)) / result.camera.focal_y_px);
  if (relative < kWorstFocal) return "";
  std::string text = "the focal length is known to no better than " +
                     (relative < 10.0 ? number(100.0 * relative) + " %" : std::string("its own size"));
  if (boards.placed.size() < 3)
    text += ", from " + std::to_string(boards.placed.size()) + " boards: photograph at least 3, better 10";
  if (tilt_spread_deg(boards) < kParallel_deg)
    text += "; the boards are parallel within " + number(tilt_spread_deg(boards)) +
            " degrees: tilt them by 20 to 45 degrees, each another way";
  return text;
}

std::vector<BoardSighting> usable(const Boards& boards) {
  std::vector<BoardSighting> sightings;
  for (const PlacedBoard& board : boards.placed) sightings.push_back(board.sighting);
  return sightings;
}

void describe(LensCalibration& result, const Boards& boards, int width_px, int height_px) {
  double squares = 0, chi2 = 0, degrees = 0;
  std::size_t points = 0;
  std::vector<BoardSighting> used;
  for (std::size_t b = 0; b < boards.placed.size(); ++b) {
    const BoardMisfit misfit = board_misfit(result.camera, boards.placed[b]);
    BoardFit& fit = result.boards[boards.place[b]];
    fit.camera_from_board = boards.placed[b].camera_from_board;
    fit.rms_px = misfit.rms_px;
    fit.reduced_chi2 = misfit.chi2 / degrees_of(boards.placed[b]);
    const std::size_t n = boards.placed[b].sighting.points();
    squares += misfit.rms_px * misfit.rms_px * static_cast<double>(n);
    points += n;
    chi2 += misfit.chi2, degrees += degrees_of(boards.placed[b]);
    used.push_back(boards.placed[b].sighting);
  }
  result.rms_px = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, points)));
  result.reduced_chi2 = chi2 / std::max(1.0, degrees);
  result.coverage = lens_coverage(width_px, height_px, used);
  for (std::string& warning : coverage_warnings(result.coverage)) result.warnings.push_back(std::move(warning));
}

// What rejected boards would have been, for the report.
void place_rejected(LensCalibration& result, const std::vector<BoardSighting>& sightings) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (result.boards[i].rejected.empty() || !unusable(sightings[i]).empty()) continue;
    const PlacedBoard placed = place_board(result.camera, sightings[i]);
    const BoardMisfit misfit = board_misfit(result.camera, placed);
    result.boards[i].camera_from_board = placed.camera_from_board;
    result.boards[i].rms_px = misfit.rms_px;
    result.boards[i].reduced_chi2 = misfit.chi2 / degrees_of(placed);
  }
}

// The usable boards, placed by a first camera. The others are listed.
Boards usable_boards(const std::vector<BoardSighting>& sightings, LensCalibration& result) {
  Boards boards;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    result.boards.push_back({.name = sightings[i].name, .rejected = unusable(sightings[i])});
    if (!result.boards[i].rejected.empty()) continue;
    boards.placed.push_back({sightings[i]});
    boards.place.push_back(i);
  }
  return boards;
}

// Without anything known beforehand: only the distortion terms that the boards ask for.
bool solve_alone(Boards& boards, LensCalibration& result) {
  bool converged = true;
  result.terms = chosen_terms(lens_vector(result.camera), lens_information(result.camera, boards.placed));
  LensVector lens = lens_vector(result.camera);
  for (std::size_t i = 0; i < result.terms.size(); ++i) {
    if (!result.terms[i]) lens[static_cast<Eigen::Index>(i)] = 0.0;
  }
  result.camera = with_lens_vector(result.camera, lens);
  if (result.terms != kAll) converged = refine_boards(result.camera, result.terms, boards.placed);
  const auto covariance = lens_covariance(lens_information(result.camera, boards.placed), result.terms);
  result.refusal = undetermined(result, covariance, boards);
  if (covariance) result.covariance = *covariance;
  return converged;
}

bool solve_with_prior(const LensPrior& prior, Boards& boards, LensCalibration& result) {
  const CombinedLens combined = combine_with_prior(result.camera, boards.placed, prior);
  result.terms = kAll;
  result.covariance = combined.covariance;
  if (combined.widened > 1.0) {
    result.warnings.push_back("the boards contradict the rig's description of the lens: its sigmas were taken " +
                              number(combined.widened) + " times as wide");
  }
  return combined.converged;
}

}  // namespace

LensCalibration calibrate_lens(int width_px, int height_px, const std::vector<BoardSighting>& sightings,
                               const std::optional<LensPrior>& prior) {
  check(width_px, height_px, sightings);
  LensCalibration result;
  Boards boards = usable_boards(sightings, result);
  constexpr std::size_t kFewestBoards = 2;
  if (boards.placed.size() < kFewestBoards) {
    result.refusal = std::to_string(boards.placed.size()) + " of " + std::to_string(sightings.size()) +
                     " photographs show a usable board: photograph at least 3, better 10, tilted by 20 to 45 degrees";
    return result;
  }
  result.camera = prior ? prior->camera : starting_camera(width_px, height_px, usable(boards));
  for (PlacedBoard& board : boards.placed) board = place_board(result.camera, board.sighting);
  const std::optional<LensPull> pull = prior ? std::optional(pull_of(*prior)) : std::nullopt;
  bool converged = fit_all_terms(result.camera, boards, pull);
  converged = reject_misfits(result.camera, boards, pull, result) && converged;
  converged = (prior ? solve_with_prior(*prior, boards, result) : solve_alone(boards, result)) && converged;
  describe(result, boards, width_px, height_px);
  place_rejected(result, sightings);
  if (!converged && result.refusal.empty()) result.refusal = "the least squares did not converge in 100 steps";
  return result;
}

}  // namespace lumitexel
