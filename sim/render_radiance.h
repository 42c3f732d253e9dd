// What the camera's lens throws onto the sensor: radiance in W/(m^2 sr) per pixel, three channels, before any noise.
//
// The lens's vignetting is in it. What drifts over a session is not: a frame's share of the point light's strength is a factor
// on the picture.
//
// Direct light only, with shadows of every part on every part. A pixel is the mean of samples_per_pixel rays on a
// regular grid over its area (a box filter by the midpoint rule; no randomness, so that highlights keep their centroid).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "processing/image/image.h"
#include "sim/simulated_world.h"

namespace lumitexel {

// Thread-safe. Results do not depend on the number of threads.
class RadianceRenderer {
 public:
  explicit RadianceRenderer(std::shared_ptr<const SimulatedWorld> world);

  // The last few states are kept, so that a bracket renders once.
  std::shared_ptr<const Image> render(const WorldState& state);

  // Unit direction in the camera's frame through a pixel, by bilinear interpolation of the lens between pixel corners
  // (error below 1e-4 px for any usable lens).
  Eigen::Vector3d direction_in_camera(double x_px, double y_px) const;
  const SimulatedWorld& world() const { return *world_; }

 private:
  Image render_uncached(const WorldState& state) const;
  Image render_scene(const WorldState& state) const;
  void darken_corners(Image& image) const;

  std::shared_ptr<const SimulatedWorld> world_;
  std::vector<Eigen::Vector3d> corner_directions_;  // z = 1; (width + 1) * (height + 1)
  std::mutex mutex_;
  std::list<std::pair<WorldState, std::shared_ptr<const Image>>> recent_;  // newest first
};

}  // namespace lumitexel
