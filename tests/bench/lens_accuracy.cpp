// How accurate corners, lens calibration and check shot are: errors against truth and against their stated sigma, which
// for the corners and the lens is the Cramer-Rao bound of their model (the inverse of the information). Prints a table.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "processing/calibration/lens/board_detection.h"
#include "processing/calibration/lens/check_lens.h"
#include "processing/calibration/lens/lens_calibration.h"
#include "processing/calibration/lens/tag_detection.h"
#include "tests/bench/machine.h"
#include "tests/unit/lens/board_placements.h"

namespace {

using namespace lumitexel;

BoardDescription one_tag() {
  BoardDescription board;
  board.pattern = BoardDescription::Pattern::TagGrid;
  board.columns = board.rows = 1;
  board.pitch_m = 0.07, board.tag_size_m = 0.05;
  return board;
}

void tag_row(double edge_px, int trials, std::uint64_t seed) {
  const CameraModel camera{200, 160, 400.0, 400.0, 101.3, 79.2};
  TagDescription printed;
  printed.size_m = 0.05;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> spread(-1.0, 1.0);
  double squares = 0, theirs = 0, whitened = 0, stated = 0;
  int found = 0;
  for (int trial = 0; trial < trials; ++trial) {
    BoardDescription board = one_tag();
    board.first_tag_id = trial % 500;
    const Eigen::Isometry3d pose =
        board_pose(camera.focal_x_px * 0.05 / edge_px, 30 * spread(random), 30 * spread(random), 180 * spread(random),
                   0.002 * spread(random), 0.002 * spread(random));
    const auto tags =
        detect_tags(noisy_picture(camera, board_electrons(camera, pose, tag_grid_pattern(board), {}), {}, random()));
    if (tags.size() != 1 || tags[0].id != board.first_tag_id) continue;
    const auto corners = printed.corners();
    Eigen::Matrix<double, 8, 1> miss;
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector2d truth = camera.project(pose * corners[c]);
      miss.segment<2>(static_cast<Eigen::Index>(2 * c)) = tags[0].corners_px[c] - truth;
      theirs += (tags[0].found_px[c] - truth).squaredNorm() / 8;
    }
    squares += miss.squaredNorm() / 8, stated += tags[0].sigma_px * tags[0].sigma_px;
    whitened += miss.dot(tags[0].covariance_px2.ldlt().solve(miss)) / 8;
    ++found;
  }
  std::printf("tag %4.0f px: found %3d of %d, RMS %.4f px, stated %.4f, whitened RMS %.2f, libapriltag %.3f px\n",
              edge_px, found, trials, std::sqrt(squares / found), std::sqrt(stated / found),
              std::sqrt(whitened / found), std::sqrt(theirs / found));
}

void lens_row(double focal_mm, int trials, std::uint64_t seed) {
  CameraModel truth = sensor_camera(focal_mm);
  truth.width_px = 4096, truth.height_px = 3072;
  const double shrunk = 4096.0 / 6000.0;
  truth.focal_x_px *= shrunk, truth.focal_y_px *= shrunk, truth.principal_x_px = 2056.0, truth.principal_y_px = 1520.5;
  const double tangent = 0.5 * truth.width_px / truth.focal_x_px;  // distortions of the same size in the picture
  truth.k1 = -0.02 / (tangent * tangent), truth.k2 = 0.01 / std::pow(tangent, 4), truth.p1 = 0.002 / tangent,
  truth.p2 = -0.001 / tangent;
  LensVector whitened = LensVector::Zero(), sigma = LensVector::Zero();
  double rms = 0, most = 0;
  int usable = 0, all_terms = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto result =
        calibrate_lens(truth.width_px, truth.height_px,
                       placements(truth, wide_board(), 12, 0.05, seed + static_cast<std::uint64_t>(trial)));
    if (!result.usable()) continue;
    ++usable;
    rms += result.rms_px, most = std::max(most, result.rms_px);
    if (!result.terms[5] || !result.terms[6]) continue;
    ++all_terms;
    whitened +=
        (lens_vector(result.camera) - lens_vector(truth)).cwiseAbs2().cwiseQuotient(result.covariance.diagonal());
    sigma += result.covariance.diagonal().cwiseSqrt();
  }
  whitened = (whitened / all_terms).cwiseSqrt(), sigma /= all_terms;
  std::printf(
      "%3.0f mm, 12 Mpixel: usable %d of %d, all terms %d; RMS %.4f px (most %.4f); sigma focal %.4f %%, principal "
      "%.2f px; "
      "scatter / stated",
      focal_mm, usable, trials, all_terms, rms / usable, most, 100 * sigma[0] / truth.focal_x_px, sigma[2]);
  for (int i = 0; i < kLensParameters; ++i) std::printf(" %.2f", whitened[i]);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("accuracy of corners and lens calibration");
  int trials = 100;
  std::uint64_t seed = 1;
  app.add_option("--trials", trials, "per row")->check(CLI::Range(2, 100000));
  app.add_option("--seed", seed, "of the first trial");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s; %d trials, seed %llu\n", machine_line().c_str(), trials, static_cast<unsigned long long>(seed));
  for (const double edge_px : {20.0, 30.0, 40.0, 60.0, 100.0}) tag_row(edge_px, trials, seed);
  for (const double focal_mm : {15.0, 35.0, 50.0, 100.0, 300.0}) lens_row(focal_mm, trials, seed);
}
