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

std::vector<std::pair<int, Blob>> find_point_highlights(const std::vector<Blob>& blobs, const CameraModel& camera,
                                                        const SphereLine& line) {
  constexpr double kLeastOfBrightest = 1.0 / 30.0;
  constexpr int kMost = 6;
  std::vector<std::pair<int, Blob>> found;
  for (int k = 0; k < line.count; ++k) {
    const MirrorSphere sphere = line.sphere(k);
    double brightest = 0.0;
    int taken = 0;
    for (const Blob& blob : blobs) {  // the brightest first
      if (taken == kMost || blob.peak < kLeastOfBrightest * brightest) break;
      if (!mirrored_ray(sphere, {Eigen::Vector3d::Zero(), camera.unproject(blob.pixel)})) continue;
      found.emplace_back(k, blob);
      brightest = std::max(brightest, blob.peak);
      ++taken;
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
