#include "processing/calibration/light/ball_in_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

cv::Mat mean_of_channels(const Image& picture) {
  cv::Mat mean(picture.height, picture.width, CV_32F);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      float sum = 0.0f;
      for (int c = 0; c < picture.channels; ++c) sum += picture.at(x, y, c);
      mean.at<float>(y, x) = sum / static_cast<float>(picture.channels);
    }
  }
  return mean;
}

bool inside(const Image& mask, float threshold, int x, int y) { return mask.contains(x, y) && mask.at(x, y) > threshold; }

double outline_rms(const Image& mask, float threshold, const BallInPicture& ball) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (inside(mask, threshold, x, y) == inside(mask, threshold, x + dx, y + dy)) continue;
        const Eigen::Vector2d edge(x + 0.5 + 0.5 * dx, y + 0.5 + 0.5 * dy);
        sum += std::pow((edge - ball.centre_px).norm() - ball.radius_px, 2);
        ++count;
      }
    }
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::int64_t>(1, count)));
}

struct Patch {
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  int pixels = 0;
};

// Connected things above the threshold on the ball, the largest first.
std::vector<Patch> patches_above(const cv::Mat& bright, const BallInPicture& ball, float threshold) {
  cv::Mat mask(bright.size(), CV_8U, cv::Scalar(0)), labels;
  for (int y = 0; y < bright.rows; ++y) {
    for (int x = 0; x < bright.cols; ++x) {
      if (ball.normal({x + 0.5, y + 0.5}) && bright.at<float>(y, x) > threshold) mask.at<std::uint8_t>(y, x) = 255;
    }
  }
  std::vector<Patch> patches(static_cast<std::size_t>(cv::connectedComponents(mask, labels, 8)));
  std::vector<double> weight(patches.size(), 0.0);
  for (int y = 0; y < bright.rows; ++y) {
    for (int x = 0; x < bright.cols; ++x) {
      const auto label = static_cast<std::size_t>(labels.at<int>(y, x));
      if (label == 0) continue;
      patches[label].centroid += bright.at<float>(y, x) * Eigen::Vector2d(x + 0.5, y + 0.5);
      weight[label] += static_cast<double>(bright.at<float>(y, x));
      ++patches[label].pixels;
    }
  }
  for (std::size_t i = 1; i < patches.size(); ++i) patches[i].centroid /= weight[i];
  patches.erase(patches.begin());
  std::stable_sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) { return a.pixels > b.pixels; });
  return patches;
}

}  // namespace

std::optional<Eigen::Vector3d> BallInPicture::normal(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d q = (pixel - centre_px) / radius_px;
  const double rest = 1.0 - q.squaredNorm();
  if (!(rest > 0.0)) return std::nullopt;
  return Eigen::Vector3d(q.x(), -q.y(), std::sqrt(rest));
}

BallInPicture ball_of_mask(const Image& mask) {
  const float brightest = mask.data.empty() ? 0.0f : *std::max_element(mask.data.begin(), mask.data.end());
  const float threshold = 0.5f * brightest;
  double area = 0.0;
  bool at_edge = false;
  BallInPicture ball;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (!inside(mask, threshold, x, y)) continue;
      ball.centre_px += Eigen::Vector2d(x + 0.5, y + 0.5);
      area += 1.0;
      at_edge = at_edge || x == 0 || y == 0 || x + 1 == mask.width || y + 1 == mask.height;
    }
  }
  if (area == 0.0 || at_edge) {
    throw BadInput("ball mask", area == 0.0 ? "nothing is marked" : "it touches the picture's edge", "a whole disc");
  }
  ball.centre_px /= area;
  ball.radius_px = std::sqrt(area / std::numbers::pi);
  ball.outline_rms_px = outline_rms(mask, threshold, ball);
  constexpr double kWholePixels = 0.5;  // a circle cut into whole pixels stays below
  if (ball.outline_rms_px > kWholePixels + 0.02 * ball.radius_px) {
    throw BadInput("ball mask", "its outline is off a circle by " + std::to_string(ball.outline_rms_px) + " px rms",
                   "a disc");
  }
  return ball;
}

std::optional<MirroredDirection> mirrored_direction(const Image& picture, const BallInPicture& ball, float maximum) {
  const cv::Mat bright = mean_of_channels(picture);
  float brightest = 0.0f;
  for (int y = 0; y < bright.rows; ++y) {
    for (int x = 0; x < bright.cols; ++x) {
      if (ball.normal({x + 0.5, y + 0.5})) brightest = std::max(brightest, bright.at<float>(y, x));
    }
  }
  if (!(brightest > 0.1f * maximum)) return std::nullopt;
  const std::vector<Patch> patches = patches_above(bright, ball, 0.5f * brightest);
  MirroredDirection result;
  result.highlight_px = patches[0].centroid;
  for (std::size_t i = 1; i < patches.size(); ++i) result.rivals += 2 * patches[i].pixels >= patches[0].pixels;
  const Eigen::Vector2d low = patches_above(bright, ball, 0.25f * brightest)[0].centroid;
  const Eigen::Vector2d high = patches_above(bright, ball, 0.75f * brightest)[0].centroid;
  for (int y = 0; y < bright.rows; ++y) {
    for (int x = 0; x < bright.cols; ++x) {
      result.clipped += ball.normal({x + 0.5, y + 0.5}) && bright.at<float>(y, x) >= maximum;
    }
  }
  const Eigen::Vector3d n = *ball.normal(result.highlight_px);
  result.direction = 2.0 * n.z() * n - Eigen::Vector3d::UnitZ();
  // The outline's hundreds of pixels err independently; a circle's centre takes two of them.
  const double outline = ball.outline_rms_px / std::sqrt(std::numbers::pi * ball.radius_px);
  result.sigma_rad = 2.0 * std::hypot((low - high).norm(), outline) / (ball.radius_px * n.z());
  return result;
}

}  // namespace lumitexel
