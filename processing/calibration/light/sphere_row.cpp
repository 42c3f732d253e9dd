#include "processing/calibration/light/sphere_row.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lumitexel {
namespace {

constexpr double kTolerancePx = 2.0;  // of a blob's centroid
// The depth along a row changes by this factor at most: more is no rig; of spheres that are missing something more is assumed.
constexpr double kMostDepthFactor = 3.0, kMostDepthFactorWithGaps = 2.0;

struct Candidate {
  Eigen::Vector2d direction;  // x/z, y/z
  double log_peak = 0;
};

std::vector<Candidate> candidates_of(const std::vector<Blob>& blobs, const CameraModel& camera) {
  std::vector<Candidate> candidates;
  for (const Blob& blob : blobs) candidates.push_back({camera.unproject(blob.pixel).hnormalized(), std::log(blob.peak)});
  return candidates;
}

// Rows of equidistant points under a projective map: t(k) = s k / (1 + h k), with t measured from the first.
struct RowHypothesis {
  Eigen::Vector2d first, along;  // along: from the first to the last
  double h = 0;
  int last = 0;  // its place
  Eigen::Vector2d at(int k) const { return first + k / (1.0 + h * k) * (1.0 + h * last) / last * along; }
};

// `between` has the given place between the first, 0, and the last.
std::optional<RowHypothesis> hypothesis(const Candidate& first, const Candidate& last, const Candidate& between, int place,
                                        int last_place, double tolerance, double most_depth_factor) {
  RowHypothesis row{first.direction, last.direction - first.direction, 0.0, last_place};
  const double length2 = row.along.squaredNorm();
  const Eigen::Vector2d to_between = between.direction - first.direction;
  const double t = to_between.dot(row.along) / length2;
  if ((to_between - t * row.along).norm() > tolerance || t <= 0.0 || t >= 1.0) return std::nullopt;
  // at(place) lies at t.
  const double n = last_place, m = place;
  row.h = (m - t * n) / (m * n * (t - 1.0));
  // The depth along the row changes by the factor 1 + h n from the first to the last.
  if (std::abs(std::log(std::abs(1.0 + row.h * n))) > std::log(most_depth_factor) || 1.0 + row.h * n <= 0.0) return std::nullopt;
  return row;
}

struct Row {
  std::vector<std::pair<int, std::size_t>> members;  // place, candidate
  double cost = 0;
};

std::optional<Row> collect(const RowHypothesis& row, const std::vector<Candidate>& candidates, double tolerance,
                           std::size_t first, int least) {
  Row found;
  constexpr double kBrightnessFactor = 3.0;
  for (int k = 0; k <= row.last; ++k) {
    if (static_cast<int>(found.members.size()) + row.last + 1 - k < least) return std::nullopt;
    const Eigen::Vector2d expected = row.at(k);
    double best = tolerance;
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double distance = (candidates[i].direction - expected).norm();
      if (distance < best && std::abs(candidates[i].log_peak - candidates[first].log_peak) < std::log(kBrightnessFactor)) {
        best = distance;
        nearest = i;
      }
    }
    if (!nearest) continue;
    found.members.emplace_back(k, *nearest);
    found.cost +=
        best * best / (tolerance * tolerance) + std::pow(candidates[*nearest].log_peak - candidates[first].log_peak, 2);
  }
  std::vector<std::size_t> unique;
  for (const auto& [place, candidate] : found.members) unique.push_back(candidate);
  std::sort(unique.begin(), unique.end());
  const bool twice = std::adjacent_find(unique.begin(), unique.end()) != unique.end();
  return twice || static_cast<int>(found.members.size()) < least ? std::nullopt : std::optional(found);
}

bool in_reading_order(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? a.x() < b.x() : a.y() < b.y();
}

// Every row of `count` places, both ends seen, with at least so many members, through any three candidates of which the middle
// one has one of the places 1 … most_place.
template <typename Take>
void search_rows(const std::vector<Blob>& blobs, const CameraModel& camera, int count, int least, int most_place,
                 double most_depth_factor, const Take& take) {
  const double tolerance = kTolerancePx / camera.focal_x_px;
  const std::vector<Candidate> candidates = candidates_of(blobs, camera);
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = 0; b < candidates.size(); ++b) {
      if (a == b || !in_reading_order(blobs[a].pixel, blobs[b].pixel)) continue;
      // Nearer together than this, the tolerance covers the row and anything fits.
      if ((candidates[b].direction - candidates[a].direction).norm() < 10.0 * tolerance * (count - 1)) continue;
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (c == a || c == b) continue;
        for (int place = 1; place <= most_place; ++place) {
          const auto row = hypothesis(candidates[a], candidates[b], candidates[c], place, count - 1, tolerance,
                                      most_depth_factor);
          if (!row) continue;
          if (const auto found = collect(*row, candidates, tolerance, a, least)) take(*found);
        }
      }
    }
  }
}

bool same_candidates(const Row& a, const Row& b) {
  return std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                    [](const auto& one, const auto& other) { return one.second == other.second; });
}

PartialRow with_blobs(const Row& row, const std::vector<Blob>& blobs) {
  PartialRow result;
  result.cost = row.cost;
  for (const auto& [place, candidate] : row.members) result.members.emplace_back(place, blobs[candidate]);
  return result;
}

}  // namespace

std::optional<std::vector<Blob>> find_sphere_row(const std::vector<Blob>& blobs, const CameraModel& camera, int count) {
  std::optional<Row> best;
  search_rows(blobs, camera, count, count, 1, kMostDepthFactor, [&](const Row& found) {
    if (!best || found.cost < best->cost) best = found;
  });
  if (!best) return std::nullopt;
  std::vector<Blob> members;
  for (const auto& [place, candidate] : best->members) members.push_back(blobs[candidate]);
  return members;
}

int least_of_row(int count) { return std::max(4, count / 2 + 1); }

std::vector<PartialRow> find_partial_rows(const std::vector<Blob>& blobs, const CameraModel& camera, int count,
                                          std::size_t most) {
  const int least = least_of_row(count);
  std::vector<Row> rows;
  for (int places = least; places <= count; ++places) {
    search_rows(blobs, camera, places, least, places - 2, kMostDepthFactorWithGaps, [&](const Row& found) {
      const auto same = [&](const Row& other) { return other.members == found.members; };
      if (std::none_of(rows.begin(), rows.end(), same)) rows.push_back(found);
    });
  }
  const std::vector<Row> all = rows;
  std::erase_if(rows, [&](const Row& row) {
    return std::count_if(all.begin(), all.end(), [&](const Row& other) { return same_candidates(row, other); }) > 1;
  });
  const auto rank = [](const Row& row) { return std::tuple(-static_cast<int>(row.members.size()), row.members.back().first, row.cost); };
  std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return rank(a) < rank(b); });
  rows.resize(std::min(rows.size(), most));
  std::vector<PartialRow> result;
  for (const Row& row : rows) result.push_back(with_blobs(row, blobs));
  return result;
}

}  // namespace lumitexel
