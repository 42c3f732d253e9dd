#include "processing/calibration/lens/lens_coverage.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

double LensCoverage::share() const {
  if (counts.empty()) return 0.0;
  const auto held = std::count_if(counts.begin(), counts.end(), [](int count) { return count > 0; });
  return static_cast<double>(held) / static_cast<double>(counts.size());
}

LensCoverage lens_coverage(int width_px, int height_px, const std::vector<BoardSighting>& sightings) {
  LensCoverage coverage;
  coverage.counts.assign(static_cast<std::size_t>(coverage.columns * coverage.rows), 0);
  for (const BoardSighting& sighting : sightings) {
    for (const Landmark& landmark : sighting.landmarks) {
      for (const Eigen::Vector2d& pixel : landmark.pixels) {
        const int c = static_cast<int>(std::floor(pixel.x() / width_px * coverage.columns));
        const int r = static_cast<int>(std::floor(pixel.y() / height_px * coverage.rows));
        if (c >= 0 && r >= 0 && c < coverage.columns && r < coverage.rows)
          ++coverage.counts[static_cast<std::size_t>(r * coverage.columns + c)];
      }
    }
  }
  return coverage;
}

std::vector<std::string> coverage_warnings(const LensCoverage& coverage) {
  std::vector<std::string> warnings;
  for (const bool lower : {false, true}) {
    for (const bool right : {false, true}) {
      if (coverage.at(right ? coverage.columns - 1 : 0, lower ? coverage.rows - 1 : 0) > 0) continue;
      std::string warning = "no points in the picture's ";
      warning.append(lower ? "lower " : "upper ").append(right ? "right" : "left");
      warning += " corner, where distortion is largest: photograph the board there, or trust the model there less";
      warnings.push_back(std::move(warning));
    }
  }
  constexpr double kEnough = 0.5;
  if (coverage.share() < kEnough) {
    warnings.push_back("the boards cover " + std::to_string(std::lround(100.0 * coverage.share())) +
                       " % of the picture: place them over all of it, at least half");
  }
  return warnings;
}

}  // namespace lumitexel
