#include "processing/render/splat_screen.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr int kBandRows = 48;  // a thread's share of the picture
constexpr float kFar = std::numeric_limits<float>::infinity();

// The first pixel whose centre is not before `edge_px`, within first to last.
int first_pixel(double edge_px, int first, int last) {
  return static_cast<int>(std::clamp(std::ceil(edge_px - 0.5), static_cast<double>(first), static_cast<double>(last)));
}

class Screen {
 public:
  Screen(const View& view, int channels, const std::vector<Splat>& splats)
      : view_(view), channels_(channels), splats_(splats), shown_(splats.size()) {
    const auto width = static_cast<std::size_t>(view.camera.width_px),
               height = static_cast<std::size_t>(view.camera.height_px);
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
    tbb::parallel_for(std::size_t{0}, bands_.size(),
                      [&](std::size_t band) { draw_band(static_cast<int>(band), result); });
    for (const auto& shown : shown_) result.shown += shown;
  }

 private:
  struct Rows {
    int first, last;
  };
  static Rows rows(const Splat& splat, int top, int bottom) {
    return {first_pixel(splat.centre_px.y() - splat.reach_px.y(), top, bottom),
            first_pixel(splat.centre_px.y() + splat.reach_px.y(), top, bottom)};
  }

  template <typename PerPixel>
  void over_pixels(const Splat& splat, int top, int bottom, const PerPixel& per_pixel) {
    const auto [first, last] = rows(splat, top, bottom);
    const int left = first_pixel(splat.centre_px.x() - splat.reach_px.x(), 0, view_.camera.width_px);
    const int right = first_pixel(splat.centre_px.x() + splat.reach_px.x(), 0, view_.camera.width_px);
    for (int y = first; y < last; ++y) {
      for (int x = left; x < right; ++x) {
        const Eigen::Vector2d centre(x + 0.5, y + 0.5);
        const double distance2 = splat.distance2(centre);
        if (distance2 < Splat::kReach2) per_pixel(pixel(x, y), centre, distance2);
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

  void add_light(std::uint32_t i, int top, int bottom, std::size_t first, std::vector<double>& weights,
                 std::vector<double>& sums) {
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

}  // namespace

void draw_splats(const View& view, const std::vector<Splat>& splats, SplatView& result) {
  Screen(view, result.radiance.channels, splats).draw(result);
}

}  // namespace lumitexel
