#include "processing/calibration/light/sphere_highlights.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lumitexel {
namespace {

constexpr int kLargestBlobPx = 15;
constexpr double kNoiseSigmas = 10.0;

// The mean of every 2x2 square: colour-neutral for a mosaic, since each holds all its colours once (green twice).
// Value (x, y) belongs to the pixel corner (x + 1, y + 1). A defective pixel counts as dark: it must not make a blob.
cv::Mat neutral_image(const MosaicRadiance& image) {
  cv::Mat neutral(image.height - 1, image.width - 1, CV_32F);
  const auto value = [&](int x, int y) {
    const std::size_t i = image.index(x, y);
    return (image.flags[i] & kPixelDefective) ? 0.0f : image.value[i];
  };
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      neutral.at<float>(y, x) = 0.25f * (value(x, y) + value(x + 1, y) + value(x, y + 1) + value(x + 1, y + 1));
    }
  }
  return neutral;
}

double noise_sigma(const MosaicRadiance& image) {
  std::vector<float> variances(image.variance);
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return 0.5 * std::sqrt(static_cast<double>(*middle));  // of a mean of four
}

Blob measured_blob(const cv::Mat& bright, const cv::Mat& labels, const cv::Rect& box, int label) {
  Blob blob;
  double sum = 0.0;
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      if (labels.at<int>(y, x) != label) continue;
      const double value = bright.at<float>(y, x);
      sum += value;
      blob.pixel += value * Eigen::Vector2d(x + 1.0, y + 1.0);
      blob.peak = std::max(blob.peak, value);
    }
  }
  blob.pixel /= sum;
  return blob;
}

// Rows of equidistant points under a projective map: t(k) = s k / (1 + h k), with t measured from the first.
struct RowHypothesis {
  Eigen::Vector2d first, along;  // along: from the first to the last
  double h = 0;
  double place(int k, int last) const { return k / (1.0 + h * k) * (1.0 + h * last) / last; }
};

struct Candidate {
  Eigen::Vector2d direction;  // x/z, y/z
  double log_peak = 0;
};

std::optional<RowHypothesis> hypothesis(const Candidate& first, const Candidate& last, const Candidate& second,
                                        int count, double tolerance) {
  RowHypothesis row{first.direction, last.direction - first.direction, 0.0};
  const double length2 = row.along.squaredNorm();
  const Eigen::Vector2d to_second = second.direction - first.direction;
  const double t = to_second.dot(row.along) / length2;
  if ((to_second - t * row.along).norm() > tolerance || t <= 0.0 || t >= 1.0) return std::nullopt;
  // place(1) = t gives h.
  const double n = count - 1.0;
  row.h = (1.0 / n - t) / (t - 1.0);
  // The depth along the row changes by the factor 1 + h n from the first to the last; more than 3 is no rig.
  if (std::abs(std::log(std::abs(1.0 + row.h * n))) > std::log(3.0) || 1.0 + row.h * n <= 0.0) return std::nullopt;
  return row;
}

struct Row {
  std::vector<std::size_t> members;
  double cost = 0;
};

std::optional<Row> collect(const RowHypothesis& row, const std::vector<Candidate>& candidates, int count,
                           double tolerance, std::size_t first) {
  Row found;
  constexpr double kBrightnessFactor = 3.0;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2d expected = row.first + row.place(k, count - 1) * row.along;
    double best = tolerance;
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double distance = (candidates[i].direction - expected).norm();
      if (distance < best &&
          std::abs(candidates[i].log_peak - candidates[first].log_peak) < std::log(kBrightnessFactor)) {
        best = distance;
        nearest = i;
      }
    }
    if (!nearest) return std::nullopt;
    found.members.push_back(*nearest);
    found.cost +=
        best * best / (tolerance * tolerance) + std::pow(candidates[*nearest].log_peak - candidates[first].log_peak, 2);
  }
  std::vector<std::size_t> unique = found.members;
  std::sort(unique.begin(), unique.end());
  if (std::adjacent_find(unique.begin(), unique.end()) != unique.end()) return std::nullopt;
  return found;
}

bool in_reading_order(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? a.x() < b.x() : a.y() < b.y();
}

}  // namespace

std::vector<Blob> compact_blobs(const MosaicRadiance& image, std::size_t most) {
  const cv::Mat neutral = neutral_image(image);
  // An opening keeps what a square of this size fits into; what it removes is compact.
  cv::Mat bright, mask, labels, statistics, centroids;
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {kLargestBlobPx + 2, kLargestBlobPx + 2});
  cv::morphologyEx(neutral, bright, cv::MORPH_TOPHAT, square);
  cv::Mat
      local_peak;  // a highlight's skirt may touch its neighbour's: count only what exceeds a fifth of the peak near it
  cv::dilate(bright, local_peak, square);
  cv::Mat above_noise = bright > kNoiseSigmas * noise_sigma(image), above_skirt = bright > 0.2 * local_peak;
  cv::bitwise_and(above_noise, above_skirt, mask);
  const int labelled = cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 8, CV_32S);
  std::vector<Blob> blobs;
  for (int label = 1; label < labelled; ++label) {
    const cv::Rect box(statistics.at<int>(label, cv::CC_STAT_LEFT), statistics.at<int>(label, cv::CC_STAT_TOP),
                       statistics.at<int>(label, cv::CC_STAT_WIDTH), statistics.at<int>(label, cv::CC_STAT_HEIGHT));
    if (std::max(box.width, box.height) > kLargestBlobPx) continue;
    blobs.push_back(measured_blob(bright, labels, box, label));
  }
  std::stable_sort(blobs.begin(), blobs.end(), [](const Blob& a, const Blob& b) { return a.peak > b.peak; });
  blobs.resize(std::min(blobs.size(), most));
  return blobs;
}

std::optional<std::vector<Blob>> find_sphere_row(const std::vector<Blob>& blobs, const CameraModel& camera, int count) {
  constexpr double kTolerancePx = 2.0;  // of a blob's centroid
  const double tolerance = kTolerancePx / camera.focal_x_px;
  std::vector<Candidate> candidates;
  for (const Blob& blob : blobs)
    candidates.push_back({camera.unproject(blob.pixel).hnormalized(), std::log(blob.peak)});
  std::optional<Row> best;
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = 0; b < candidates.size(); ++b) {
      if (a == b || !in_reading_order(blobs[a].pixel, blobs[b].pixel)) continue;
      // Nearer together than this, the tolerance covers the row and anything fits.
      if ((candidates[b].direction - candidates[a].direction).norm() < 10.0 * tolerance * (count - 1)) continue;
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (c == a || c == b) continue;
        const auto row = hypothesis(candidates[a], candidates[b], candidates[c], count, tolerance);
        if (!row) continue;
        auto found = collect(*row, candidates, count, tolerance, a);
        if (found && (!best || found->cost < best->cost)) best = std::move(found);
      }
    }
  }
  if (!best) return std::nullopt;
  std::vector<Blob> members;
  for (const std::size_t i : best->members) members.push_back(blobs[i]);
  return members;
}

std::vector<std::pair<int, Blob>> find_point_highlights(const std::vector<Blob>& blobs, const CameraModel& camera,
                                                        const SphereLine& line) {
  std::vector<std::pair<int, Blob>> found;
  for (int k = 0; k < line.count; ++k) {
    const MirrorSphere sphere = line.sphere(k);
    for (const Blob& blob : blobs) {  // the brightest first
      if (!mirrored_ray(sphere, {Eigen::Vector3d::Zero(), camera.unproject(blob.pixel)})) continue;
      found.emplace_back(k, blob);
      break;
    }
  }
  return found;
}

std::optional<ColourBalance> colour_balance(const std::vector<FittedHighlight>& free_fits) {
  if (free_fits.empty()) return std::nullopt;
  ColourBalance balance{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const FittedHighlight& fit : free_fits) values.push_back(fit.balance[c]);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    balance[c] = *middle;
  }
  return balance;
}

}  // namespace lumitexel
