#include "processing/render/splat.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/error.h"
#include "processing/render/lamp_light.h"
#include "processing/render/surface_points.h"
#include "processing/render/texel_brdf.h"

namespace lumitexel {
namespace {

// One sigma of the kernel in texels, and in pixels. Any point between texels is within 0.71 steps of one of them.
constexpr double kTexelSigma = 0.45, kPixelSigma = 0.35;
constexpr double kReach2 = 9.0;    // squared Mahalanobis distance up to which a kernel counts: 1.35 steps
// A point hides what is behind it in the pixel whose centre is nearest, and 0.9 steps around, so that four neighbours close the gap
// between them. No farther: at an outline the pixel's own blur would make the object grow.
constexpr double kSolid2 = 4.0, kNearestPixel = 0.5;
constexpr double kThinnest = 0.05;  // pixels: of a texel seen from its edge, so that its ellipse can be inverted
constexpr double kBehind = 1.0;    // steps behind the nearest that still count as the same surface
// Drawn so many times finer than asked for and averaged, so that outlines cover parts of pixels; odd, so that a centre stays one.
constexpr int kFiner = 3;
constexpr int kBandRows = 48;      // a thread's share of the picture
constexpr float kFar = std::numeric_limits<float>::infinity();

struct Splat {
  Eigen::Vector2d centre_px;
  Eigen::Matrix2d inverse_covariance, inverse_solid;  // with the pixel's blur, and of the texel alone
  Eigen::Vector2d reach_px;           // half the box that the kernel fills
  Eigen::Vector3d plane_in_camera;    // normal over its distance from the camera: depth = 1 / (plane . ray), ray with z = 1
  double depth_m = 0, depth_slack_m = 0, behind_m = 0;
  ChannelValues radiance{};
  bool faces_camera = false, on_screen = false;

  double distance2(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d off = pixel - centre_px;
    return off.dot(inverse_covariance * off);
  }
  bool is_solid_at(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d off = pixel - centre_px;
    return off.cwiseAbs().maxCoeff() <= kNearestPixel || off.dot(inverse_solid * off) < kSolid2;
  }
  // Of the tangent plane, but no farther from the point's own than its kernel reaches.
  double depth_at(const Eigen::Vector3d& ray) const {
    const double along = plane_in_camera.dot(ray);
    const double depth = along > 0.0 ? 1.0 / along : depth_m;
    return std::clamp(depth, depth_m - depth_slack_m, depth_m + depth_slack_m);
  }
};

// The kernel on the screen. False where the point is behind the camera, or nothing of it on the screen.
bool project(const View& view, const TexturedPoint& point, const SurfacePoint& source, Splat& splat) {
  const Eigen::Vector3d x = view.camera_from_world * point.position_in_world;
  const Eigen::Matrix<double, 3, 2> steps = view.camera_from_world.linear() * source.steps;
  Eigen::Matrix2d on_screen;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d before = x - 0.5 * steps.col(axis), after = x + 0.5 * steps.col(axis);
    if (!(before.z() > 0.0) || !(after.z() > 0.0)) return false;
    on_screen.col(axis) = view.camera.project(after) - view.camera.project(before);
  }
  const Eigen::Matrix2d texel = kTexelSigma * kTexelSigma * on_screen * on_screen.transpose();
  const Eigen::Matrix2d covariance = texel + kPixelSigma * kPixelSigma * Eigen::Matrix2d::Identity();
  splat.centre_px = view.camera.project(x);
  splat.inverse_covariance = covariance.inverse();
  splat.inverse_solid = (texel + kThinnest * kThinnest * Eigen::Matrix2d::Identity()).inverse();
  splat.reach_px = (kReach2 * covariance.diagonal()).cwiseSqrt();
  splat.depth_m = x.z();
  splat.depth_slack_m = std::sqrt(kReach2) * kTexelSigma * (std::abs(steps(2, 0)) + std::abs(steps(2, 1)));
  splat.behind_m = kBehind * std::max(steps.col(0).norm(), steps.col(1).norm());
  const Eigen::Vector3d normal = view.camera_from_world.linear() * point.geometric_normal;
  splat.plane_in_camera = normal / normal.dot(x);
  splat.faces_camera = normal.dot(x) < 0.0;
  const Eigen::Vector2d size(view.camera.width_px, view.camera.height_px);
  return ((splat.centre_px + splat.reach_px).array() > 0.0).all() &&
         ((splat.centre_px - splat.reach_px).array() < size.array()).all();
}

class Screen {
 public:
  Screen(const View& view, int channels, const std::vector<Splat>& splats)
      : view_(view), channels_(channels), splats_(splats), shown_(splats.size()) {
    const auto width = static_cast<std::size_t>(view.camera.width_px), height = static_cast<std::size_t>(view.camera.height_px);
    rays_.resize(width * height);
    depth_.assign(width * height, kFar);
    bands_.resize((height + kBandRows - 1) / kBandRows);
    for (std::size_t i = 0; i < splats.size(); ++i) {
      if (!splats[i].on_screen) continue;
      const auto [first, last] = rows(splats[i], 0, view.camera.height_px);
      for (int band = first / kBandRows; band <= (last - 1) / kBandRows && first < last; ++band) {
        bands_[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(i));
      }
    }
  }

  void draw(SplatView& result) {
    tbb::parallel_for(std::size_t{0}, bands_.size(), [&](std::size_t band) { draw_band(static_cast<int>(band), result); });
    for (const auto& shown : shown_) result.shown += shown;
  }

 private:
  struct Rows {
    int first, last;
  };
  static Rows rows(const Splat& splat, int top, int bottom) {  // whose pixel centres the kernel's box holds
    return {std::max(top, static_cast<int>(std::ceil(splat.centre_px.y() - splat.reach_px.y() - 0.5))),
            std::min(bottom, static_cast<int>(std::floor(splat.centre_px.y() + splat.reach_px.y() - 0.5)) + 1)};
  }

  template <typename PerPixel>
  void over_pixels(const Splat& splat, int top, int bottom, const PerPixel& per_pixel) {
    const auto [first, last] = rows(splat, top, bottom);
    const int left = std::max(0, static_cast<int>(std::ceil(splat.centre_px.x() - splat.reach_px.x() - 0.5)));
    const int right = std::min(view_.camera.width_px, static_cast<int>(std::floor(splat.centre_px.x() + splat.reach_px.x() - 0.5)) + 1);
    for (int y = first; y < last; ++y) {
      for (int x = left; x < right; ++x) {
        const Eigen::Vector2d centre(x + 0.5, y + 0.5);
        const double distance2 = splat.distance2(centre);
        if (distance2 < kReach2) per_pixel(pixel(x, y), centre, distance2);
      }
    }
  }

  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.camera.width_px) + static_cast<std::size_t>(x);
  }

  void draw_band(int band, SplatView& result) {
    const int top = band * kBandRows, bottom = std::min(view_.camera.height_px, top + kBandRows);
    for (int y = top; y < bottom; ++y) {
      for (int x = 0; x < view_.camera.width_px; ++x) {
        const Eigen::Vector3d ray = view_.camera.unproject({x + 0.5, y + 0.5});
        rays_[pixel(x, y)] = ray / ray.z();
      }
    }
    const std::vector<std::uint32_t>& here = bands_[static_cast<std::size_t>(band)];
    for (const std::uint32_t i : here) {
      const Splat& splat = splats_[i];
      over_pixels(splat, top, bottom, [&](std::size_t at, const Eigen::Vector2d& centre, double) {
        if (splat.is_solid_at(centre)) depth_[at] = std::min(depth_[at], static_cast<float>(splat.depth_at(rays_[at])));
      });
    }
    const auto first = pixel(0, top), count = pixel(0, bottom) - first;
    std::vector<double> weights(count, 0.0), sums(count * static_cast<std::size_t>(channels_), 0.0);
    for (const std::uint32_t i : here) add_light(i, top, bottom, first, weights, sums);
    for (std::size_t p = 0; p < count; ++p) {
      result.hit[first + p] = depth_[first + p] < kFar;
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels_) && weights[p] > 0.0; ++c) {
        const std::size_t value = p * static_cast<std::size_t>(channels_) + c;
        result.radiance.data[first * static_cast<std::size_t>(channels_) + value] =
            static_cast<float>(sums[value] / weights[p]);
      }
    }
  }

  void add_light(std::uint32_t i, int top, int bottom, std::size_t first, std::vector<double>& weights, std::vector<double>& sums) {
    const Splat& splat = splats_[i];
    if (!splat.faces_camera) return;
    over_pixels(splat, top, bottom, [&](std::size_t at, const Eigen::Vector2d&, double distance2) {
      if (depth_[at] == kFar || splat.depth_at(rays_[at]) > depth_[at] + splat.behind_m) return;
      const double weight = std::exp(-0.5 * distance2);
      weights[at - first] += weight;
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
        sums[(at - first) * static_cast<std::size_t>(channels_) + c] += weight * splat.radiance[c];
      }
      shown_[i].store(1, std::memory_order_relaxed);
    });
  }

  const View& view_;
  int channels_;
  const std::vector<Splat>& splats_;
  std::vector<std::atomic<std::uint8_t>> shown_;  // a splat may reach into two bands
  std::vector<Eigen::Vector3d> rays_;
  std::vector<float> depth_;
  std::vector<std::vector<std::uint32_t>> bands_;
};

std::vector<Splat> lit_splats(const Model& model, const View& view, const std::vector<Light>& lamps, FitStage stage) {
  const ModelSurface surface(model);
  const ReflectingModel reflecting(model, stage);
  const std::vector<SurfacePoint> points = surface_points(model);
  const Eigen::Vector3d eye = view.camera_in_world();
  std::vector<Splat> splats(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024), [&](const auto& range) {
    TexelReflection texel(reflecting);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const TexturedPoint point = textured(model, points[i]);
      splats[i].on_screen = project(view, point, points[i], splats[i]);
      const Eigen::Vector3d wo = (eye - point.position_in_world).normalized();
      if (!splats[i].on_screen || !splats[i].faces_camera) continue;
      if (!texel.set(points[i].x, points[i].y, surface.shading_normal(point.texels[0], point), wo)) continue;
      splats[i].radiance = light_of_lamps(surface, point, texel, lamps);
    }
  });
  return splats;
}

View finer_view(View view) {
  CameraModel& camera = view.camera;
  camera.width_px *= kFiner;
  camera.height_px *= kFiner;
  for (double* length_px : {&camera.focal_x_px, &camera.focal_y_px, &camera.principal_x_px, &camera.principal_y_px}) {
    *length_px *= kFiner;
  }
  return view;
}

void average(const SplatView& fine, SplatView& result) {
  Image& image = result.radiance;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (int i = 0; i < kFiner * kFiner; ++i) sum += fine.radiance.at(kFiner * x + i % kFiner, kFiner * y + i / kFiner, c);
        image.at(x, y, c) = static_cast<float>(sum / (kFiner * kFiner));
      }
      const std::size_t centre = fine.radiance.offset(kFiner * x + kFiner / 2, kFiner * y + kFiner / 2) /
                                 static_cast<std::size_t>(image.channels);
      result.hit[image.offset(x, y) / static_cast<std::size_t>(image.channels)] = fine.hit[centre];
    }
  }
}

SplatView empty_view(const View& view, int channels) {
  SplatView result{Image(view.camera.width_px, view.camera.height_px, channels), {}, 0, 0};
  result.hit.resize(static_cast<std::size_t>(view.camera.width_px) * static_cast<std::size_t>(view.camera.height_px));
  return result;
}

}  // namespace

SplatView splat(const Model& model, const View& view, const std::vector<Light>& lamps, FitStage stage) {
  check_lamps(view, lamps, model.channels);
  const View finer = finer_view(view);
  const std::vector<Splat> splats = lit_splats(model, finer, lamps, stage);
  SplatView fine = empty_view(finer, model.channels), result = empty_view(view, model.channels);
  Screen(finer, model.channels, splats).draw(fine);
  average(fine, result);
  result.points = static_cast<std::int64_t>(splats.size());
  result.shown = fine.shown;
  return result;
}

}  // namespace lumitexel
