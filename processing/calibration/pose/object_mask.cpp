#include "processing/calibration/pose/object_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kModesApart = 4.0;  // a lit panel is at least this many times as bright as what stands before it

cv::Mat projection_of(const Mesh& mesh, const CameraModel& camera, const Eigen::Isometry3d& camera_from_mesh) {
  // OpenCV's polygons take integer corners with a number of fractional bits; its pixel centres are at whole numbers.
  constexpr int kFractionBits = 4;
  const auto fixed = [](double v) { return static_cast<int>(std::lround((v - 0.5) * (1 << kFractionBits))); };
  cv::Mat picture = cv::Mat::zeros(camera.height_px, camera.width_px, CV_8U);
  for (const auto& triangle : mesh.triangles) {
    std::array<cv::Point, 3> corners;
    bool in_front = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d x = camera_from_mesh * mesh.positions[triangle[k]];
      in_front = in_front && x.z() > 0.0;
      if (!in_front) break;
      const Eigen::Vector2d pixel = camera.project(x);
      in_front = pixel.cwiseAbs().maxCoeff() < 1e5;  // far out of the picture: no corner there, and no overflow
      if (!in_front) break;
      corners[k] = {fixed(pixel.x()), fixed(pixel.y())};
    }
    if (in_front) cv::fillConvexPoly(picture, corners.data(), 3, 255, cv::LINE_8, kFractionBits);
  }
  return picture;
}

// 5x5 means: every colour of the mosaic takes part, and the threshold need not know their balance. Log scale, because
// panel and object differ by factors.
cv::Mat smooth_log(const MosaicRadiance& image) {
  cv::Mat value(image.height, image.width, CV_32F), smooth;
  std::copy(image.value.begin(), image.value.end(), value.ptr<float>());
  cv::GaussianBlur(value, smooth, {5, 5}, 1.0);
  std::vector<float> variances(image.variance);
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  cv::max(smooth, std::max(std::sqrt(*middle), 1e-20f), smooth);  // below the noise all is equally dark
  cv::log(smooth, smooth);
  return smooth;
}

// The threshold that separates two modes best (largest variance between the classes), and the modes' distance.
struct Split {
  double threshold, distance;
};

Split split_modes(const cv::Mat& values, const cv::Mat& where) {
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(values, &low, &high, nullptr, nullptr, where);
  constexpr int kBins = 256;
  std::array<double, kBins> histogram{};
  const double per_bin = std::max(high - low, 1e-9) / kBins;
  double total = 0.0, total_sum = 0.0;
  for (int y = 0; y < values.rows; ++y) {
    for (int x = 0; x < values.cols; ++x) {
      if (!where.at<std::uint8_t>(y, x)) continue;
      const int bin = std::clamp(static_cast<int>((values.at<float>(y, x) - low) / per_bin), 0, kBins - 1);
      histogram[static_cast<std::size_t>(bin)] += 1.0;
      total += 1.0;
      total_sum += bin;
    }
  }
  Split split{low, 0.0};
  double count = 0.0, sum = 0.0, best = -1.0;
  for (int bin = 0; bin + 1 < kBins; ++bin) {
    count += histogram[static_cast<std::size_t>(bin)];
    sum += bin * histogram[static_cast<std::size_t>(bin)];
    if (count == 0.0 || count == total) continue;
    const double apart = (total_sum - sum) / (total - count) - sum / count;
    const double between = count * (total - count) * apart * apart;
    if (between <= best) continue;
    best = between;
    // Half of the panel's brightness: where the object covers half of a pixel.
    split = {low + per_bin * (0.5 + (total_sum - sum) / (total - count)) - std::log(2.0), apart * per_bin};
  }
  return split;
}

}  // namespace

ObjectMask find_object(const MosaicRadiance& silhouette, const Mesh& mesh, const CameraModel& camera,
                       const Eigen::Isometry3d& camera_from_mesh, int margin_px) {
  const cv::Mat projection = projection_of(mesh, camera, camera_from_mesh);
  if (cv::countNonZero(projection) == 0)
    throw BadInput("mesh", "no part of it is in a view's picture", "a mesh in sight");
  cv::Mat allowed, surroundings;
  const auto ellipse = [](int r) { return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * r + 1, 2 * r + 1}); };
  cv::dilate(projection, allowed, ellipse(margin_px));
  cv::dilate(allowed, surroundings, ellipse(3 * margin_px));  // where object and panel are both seen, and little else
  const cv::Mat values = smooth_log(silhouette);
  const Split split = split_modes(values, surroundings);
  ObjectMask mask;
  mask.from_silhouette = split.distance > std::log(kModesApart);
  mask.threshold = std::exp(split.threshold);
  mask.inside.resize(silhouette.value.size());
  for (int y = 0; y < silhouette.height; ++y) {
    for (int x = 0; x < silhouette.width; ++x) {
      const bool inside = mask.from_silhouette
                              ? allowed.at<std::uint8_t>(y, x) && values.at<float>(y, x) < split.threshold
                              : projection.at<std::uint8_t>(y, x) != 0;
      mask.inside[silhouette.index(x, y)] = inside ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace lumitexel
