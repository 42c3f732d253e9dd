#include "processing/calibration/pose/silhouette_contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/error.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

constexpr int kReach = 4;         // pixels each side of an edge whose sum is taken: blur and an oblique edge's run
constexpr int kLevelPixels = 4;   // beyond them, for the local levels
constexpr int kPanelReach = 12;   // how far the panel may be from an edge's pixel
constexpr double kPanelShare = 0.3;      // of the panel's level: brighter than any dark thing, darker than any vignette
constexpr double kLevelTolerance = 0.2;  // of the local contrast, between an edge's levels and its surroundings'
constexpr double kGrain_px = 0.02;       // what is left of blur that is not even, of the window's ends

struct Field {
  cv::Mat value, variance;  // float; panel of one level in all colours
  cv::Mat unusable;         // 1 defective, 2 saturated
};

float quantile(std::vector<float> values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// The panel's level per colour: the mean of what is brighter than a third of the colour's brightest percentile.
std::array<double, 3> panel_levels(const MosaicRadiance& image) {
  std::array<std::vector<float>, 3> values;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float value = image.value[image.index(x, y)];
      if (!std::isfinite(value)) throw BadInput("silhouette", "a value that is not finite", "finite radiance");
      values[static_cast<std::size_t>(mosaic_channel(image.mosaic, x, y))].push_back(value);
    }
  }
  std::array<double, 3> levels{1, 1, 1};
  for (std::size_t c = 0; c < 3; ++c) {
    if (values[c].empty()) continue;
    const double bound = kPanelShare * quantile(values[c], 0.99);
    double sum = 0.0;
    std::size_t count = 0;
    for (const float value : values[c]) {
      if (value <= bound) continue;
      sum += value;
      ++count;
    }
    levels[c] = count > 0 && sum > 0.0 ? sum / static_cast<double>(count) : 1.0;
  }
  return levels;
}

Field balanced(const MosaicRadiance& image) {
  const std::array<double, 3> levels = panel_levels(image);
  Field field{cv::Mat(image.height, image.width, CV_32F), cv::Mat(image.height, image.width, CV_32F),
              cv::Mat::zeros(image.height, image.width, CV_8U)};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i = image.index(x, y);
      const double level = levels[static_cast<std::size_t>(mosaic_channel(image.mosaic, x, y))];
      field.value.at<float>(y, x) = static_cast<float>(image.value[i] / level);
      field.variance.at<float>(y, x) = static_cast<float>(image.variance[i] / (level * level));
      field.unusable.at<std::uint8_t>(y, x) =
          image.flags[i] & kPixelDefective ? 1 : image.flags[i] & kPixelSaturated ? 2 : 0;
    }
  }
  return field;
}

// One place where the smoothed picture passes the middle between dark and bright, with the step towards the bright side.
struct Crossing {
  int x, y, step_x, step_y;  // the last dark pixel; one of the steps is 0
  double bright, dark;       // of the surroundings
};

enum class Outcome { Found, Unfit, Saturated };

Outcome measure(const Field& field, const Crossing& at, const Eigen::Vector2d& normal, ContourPoint& point) {
  constexpr int kEnd = kReach + kLevelPixels;  // the last dark pixel is place 0, the first bright one place 1
  const auto place = [&](int k) { return cv::Point(at.x + k * at.step_x, at.y + k * at.step_y); };
  const cv::Rect picture(0, 0, field.value.cols, field.value.rows);
  if (!picture.contains(place(1 - kEnd)) || !picture.contains(place(kEnd))) return Outcome::Unfit;
  double sum = 0.0, variance = 0.0, bright = 0.0, dark = 0.0;
  for (int k = 1 - kEnd; k <= kEnd; ++k) {
    if (const std::uint8_t flag = field.unusable.at<std::uint8_t>(place(k))) {
      return flag == 2 ? Outcome::Saturated : Outcome::Unfit;
    }
    const double value = field.value.at<float>(place(k));
    if (k > kReach) {
      bright += value / kLevelPixels;
    } else if (k < 1 - kReach) {
      dark += value / kLevelPixels;
    } else {
      sum += value;
      variance += field.variance.at<float>(place(k));
    }
  }
  // The local mean is noisier than the surroundings' extremes, but not biased by the noise.
  const double contrast = at.bright - at.dark;
  if (std::abs(bright - at.bright) > kLevelTolerance * contrast || std::abs(dark - at.dark) > kLevelTolerance * contrast)
    return Outcome::Unfit;
  const double from_far_end = (2 * kReach * bright - sum) / (bright - dark);  // dark pixels' count
  const double edge = from_far_end + (1 - kReach) - 0.5;                      // in places, from place 0's centre
  if (!(edge > -1.5 && edge < 2.5)) return Outcome::Unfit;
  point.pixel = Eigen::Vector2d(at.x + 0.5 + edge * at.step_x, at.y + 0.5 + edge * at.step_y);
  point.normal = normal;
  const double obliquity = std::abs(at.step_x * normal.x() + at.step_y * normal.y());
  // The two levels' noise moves the edge by half of the window each
  // (nearly all of the noise is the bright half's, kReach pixels').
  const double levels = kReach * variance / kLevelPixels;
  point.sigma_px = std::hypot(std::sqrt(variance + levels) / (bright - dark) * obliquity, kGrain_px);
  return Outcome::Found;
}

SilhouetteContour trace(const Field& field) {
  SilhouetteContour contour{field.value.cols, field.value.rows, {}, 0.0};
  cv::Mat smooth, bright, dark;
  cv::GaussianBlur(field.value, smooth, {5, 5}, 1.0);
  const cv::Mat block = cv::getStructuringElement(cv::MORPH_RECT, {2 * kPanelReach + 1, 2 * kPanelReach + 1});
  cv::dilate(smooth, bright, block);
  cv::erode(smooth, dark, block);
  std::size_t saturated = 0;
  const auto examine = [&](int x, int y, int dx, int dy) {
    const float a = smooth.at<float>(y, x), b = smooth.at<float>(y + dy, x + dx);
    const float high = bright.at<float>(y, x), low = dark.at<float>(y, x);
    if (high < kPanelShare || low > kPanelShare * high) return;
    const float middle = 0.5f * (high + low);
    if ((a < middle) == (b < middle)) return;
    const Eigen::Vector2d slope(smooth.at<float>(y, x + 1) - smooth.at<float>(y, x - 1) + smooth.at<float>(y + dy, x + dx + 1) -
                                    smooth.at<float>(y + dy, x + dx - 1),
                                smooth.at<float>(y + 1, x) - smooth.at<float>(y - 1, x) + smooth.at<float>(y + dy + 1, x + dx) -
                                    smooth.at<float>(y + dy - 1, x + dx));
    const bool upright = std::abs(slope.x()) >= std::abs(slope.y());
    if (upright != (dx == 1)) return;
    const bool forward = a < middle;
    const Crossing at{forward ? x : x + dx, forward ? y : y + dy, forward ? dx : -dx, forward ? dy : -dy, high, low};
    ContourPoint point;
    const Outcome outcome = measure(field, at, slope.normalized(), point);
    if (outcome == Outcome::Found) contour.points.push_back(point);
    if (outcome == Outcome::Saturated) ++saturated;
  };
  for (int y = 1; y + 2 < field.value.rows; ++y) {
    for (int x = 1; x + 2 < field.value.cols; ++x) {
      examine(x, y, 1, 0);
      examine(x, y, 0, 1);
    }
  }
  const double found = static_cast<double>(contour.points.size() + saturated);
  contour.saturated = found > 0.0 ? static_cast<double>(saturated) / found : 0.0;
  return contour;
}

}  // namespace

SilhouetteContour silhouette_contour(const MosaicRadiance& backlit) {
  const std::size_t size = static_cast<std::size_t>(backlit.width) * static_cast<std::size_t>(backlit.height);
  if (backlit.width < 32 || backlit.height < 32 || backlit.value.size() != size || backlit.variance.size() != size ||
      backlit.flags.size() != size)
    throw BadInput("silhouette", std::to_string(backlit.width) + " x " + std::to_string(backlit.height) + " pixels",
                   "at least 32 x 32, with variance and flags");
  return trace(balanced(backlit));
}

SilhouetteContour silhouette_contour(const RadianceImage& backlit) {
  MosaicRadiance mono;
  mono.width = backlit.radiance.width;
  mono.height = backlit.radiance.height;
  const int channels = backlit.radiance.channels;
  for (int y = 0; y < mono.height; ++y) {
    for (int x = 0; x < mono.width; ++x) {
      float sum = 0.0f, variance = 0.0f;
      for (int c = 0; c < channels; ++c) {
        sum += backlit.radiance.at(x, y, c);
        variance += backlit.variance.at(x, y, c);
      }
      mono.value.push_back(sum / static_cast<float>(channels));
      mono.variance.push_back(variance / static_cast<float>(channels * channels));
      mono.flags.push_back(backlit.flag(x, y));
    }
  }
  return silhouette_contour(mono);
}

SilhouetteContour contour_of_mask(const std::vector<std::uint8_t>& inside, int width_px, int height_px) {
  MosaicRadiance mono;
  mono.width = width_px;
  mono.height = height_px;
  for (const std::uint8_t pixel : inside) mono.value.push_back(pixel ? 0.0f : 1.0f);
  mono.variance.assign(inside.size(), 0.0f);
  mono.flags.assign(inside.size(), 0);
  SilhouetteContour contour = silhouette_contour(mono);
  constexpr double kMaskGrain_px = 0.29;  // a whole pixel, evenly spread
  for (ContourPoint& point : contour.points) point.sigma_px = kMaskGrain_px;
  return contour;
}

}  // namespace lumitexel
