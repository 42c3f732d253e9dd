#include "sim/render_radiance.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

struct Emitter {
  Eigen::Vector3d position;  // in the table's frame
  Eigen::Array3d w_per_sr;
};

// One world state made ready for shading; everything in the table's frame.
class ShadedScene {
 public:
  ShadedScene(const SimulatedWorld& world, const WorldState& state)
      : world_(world), state_(state), scene_(world, state.turntable_deg) {
    const Eigen::Isometry3d& table_from_rig = scene_.table_from_rig();
    table_from_camera_ = table_from_rig * world.rig.camera.camera_from_rig.inverse();
    const Eigen::Vector3d light = world.point_light_in_rig(state.light_azimuth_deg, state.light_elevation_deg);
    point_light_ = {table_from_rig * light, world.settings.point_light_w_per_sr};
    const double share = 1.0 / world.settings.ring_flash_emitters;
    for (const Eigen::Vector3d& position : world.ring_emitters_in_rig()) {
      ring_.push_back({table_from_rig * position, share * world.settings.ring_flash_w_per_sr});
    }
    steel_ = {world.settings.sphere_roughness, world.settings.sphere_reflectance, Eigen::Array3d::Zero()};
  }

  // ray_key chooses among the ring flash's emitters.
  Eigen::Array3d radiance_along(const Eigen::Vector3d& direction_in_camera, std::uint64_t ray_key) const {
    const Eigen::Vector3d direction = table_from_camera_.linear() * direction_in_camera;
    const SceneHit hit = scene_.closest(table_from_camera_.translation(), direction);
    if (hit.part == ScenePart::Nothing) return Eigen::Array3d::Zero();
    if (hit.part == ScenePart::Backlight) {
      return state_.backlight ? world_.settings.backlight_w_per_m2_sr : Eigen::Array3d::Zero();
    }
    const bool lit = state_.point_light || state_.ring_flash;
    if (!lit || hit.facet.dot(direction) >= 0.0) return Eigen::Array3d::Zero();
    const PatternPoint pattern = hit.part == ScenePart::Object ? world_.pattern.at(hit.point) : PatternPoint{};
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    if (state_.point_light) sum += reflected(hit, pattern, -direction, point_light_);
    if (state_.ring_flash) sum += ring_reflected(hit, pattern, -direction, ray_key);
    return sum;
  }

 private:
  Eigen::Array3d brdf_at(const SceneHit& hit, const PatternPoint& pattern, const LobeGeometry& geometry) const {
    if (hit.part == ScenePart::Sphere) return evaluate(steel_, geometry);
    if (hit.part == ScenePart::GrayCard) return Eigen::Array3d::Constant(world_.rig.gray_card.albedo / std::numbers::pi);
    Eigen::Array3d f = Eigen::Array3d::Zero();
    for (std::size_t m = 0; m < world_.materials.size(); ++m) {
      if (pattern.weight[m] > 0.0) {
        f += pattern.weight[m] * evaluate(world_.materials[m], geometry, pattern.albedo_scale);
      }
    }
    return f;
  }

  Eigen::Array3d reflected(const SceneHit& hit, const PatternPoint& pattern, const Eigen::Vector3d& wo,
                           const Emitter& emitter) const {
    const Eigen::Vector3d to_light = emitter.position - hit.point;
    const double distance_sq = to_light.squaredNorm();
    const Eigen::Vector3d wi = to_light / std::sqrt(distance_sq);
    const LobeGeometry geometry = lobe_geometry(hit.normal, wi, wo);
    if (!(geometry.cos_i > 0.0 && geometry.cos_o > 0.0) || hit.facet.dot(wi) <= 0.0) return Eigen::Array3d::Zero();
    if (scene_.shadowed(hit, emitter.position)) return Eigen::Array3d::Zero();
    return brdf_at(hit, pattern, geometry) * emitter.w_per_sr * (geometry.cos_i / distance_sq);
  }

  // The spheres' highlights are images of the whole ring, so they see all of it; for the rest, which the ring lights
  // evenly, one emitter a ray is enough.
  Eigen::Array3d ring_reflected(const SceneHit& hit, const PatternPoint& pattern, const Eigen::Vector3d& wo,
                                std::uint64_t ray_key) const {
    if (hit.part != ScenePart::Sphere) {
      const std::size_t chosen = scrambled(ray_key) % ring_.size();
      return static_cast<double>(ring_.size()) * reflected(hit, pattern, wo, ring_[chosen]);
    }
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (const Emitter& emitter : ring_) sum += reflected(hit, pattern, wo, emitter);
    return sum;
  }

  const SimulatedWorld& world_;
  WorldState state_;
  PlacedScene scene_;
  Eigen::Isometry3d table_from_camera_;
  Emitter point_light_;
  std::vector<Emitter> ring_;
  GgxBrdf steel_;
};

// A lamp's place does not matter while it is dark; the states of all silhouettes of one angle are then one.
WorldState canonical(WorldState state) {
  if (!state.point_light) state.light_azimuth_deg = state.light_elevation_deg = 0.0;
  if (!state.point_light && !state.ring_flash && !state.backlight) state.turntable_deg = 0.0;
  return state;
}

}  // namespace

RadianceRenderer::RadianceRenderer(std::shared_ptr<const SimulatedWorld> world) : world_(std::move(world)) {
  const CameraModel& camera = world_->camera;
  for (int y = 0; y <= camera.height_px; ++y) {
    for (int x = 0; x <= camera.width_px; ++x) {
      const Eigen::Vector3d direction = camera.unproject(Eigen::Vector2d(x, y));
      corner_directions_.push_back(direction / direction.z());
    }
  }
}

Eigen::Vector3d RadianceRenderer::direction_in_camera(double x_px, double y_px) const {
  const int x = std::clamp(static_cast<int>(x_px), 0, world_->camera.width_px - 1);
  const int y = std::clamp(static_cast<int>(y_px), 0, world_->camera.height_px - 1);
  const double u = x_px - x, v = y_px - y;
  const auto corner = [&](int i, int j) -> const Eigen::Vector3d& {
    return corner_directions_[static_cast<std::size_t>(j) * static_cast<std::size_t>(world_->camera.width_px + 1) +
                              static_cast<std::size_t>(i)];
  };
  const Eigen::Vector3d upper = (1.0 - u) * corner(x, y) + u * corner(x + 1, y);
  const Eigen::Vector3d lower = (1.0 - u) * corner(x, y + 1) + u * corner(x + 1, y + 1);
  return ((1.0 - v) * upper + v * lower).normalized();
}

std::shared_ptr<const Image> RadianceRenderer::render(const WorldState& wanted) {
  constexpr std::size_t kKept = 4;
  const WorldState state = canonical(wanted);
  const std::lock_guard lock(mutex_);
  for (auto kept = recent_.begin(); kept != recent_.end(); ++kept) {
    if (kept->first == state) {
      recent_.splice(recent_.begin(), recent_, kept);
      return recent_.front().second;
    }
  }
  recent_.emplace_front(state, std::make_shared<const Image>(render_uncached(state)));
  if (recent_.size() > kKept) recent_.pop_back();
  return recent_.front().second;
}

Image RadianceRenderer::render_uncached(const WorldState& state) const {
  const int width = world_->camera.width_px, height = world_->camera.height_px;
  Image image(width, height, 3);
  if (canonical(state) == WorldState{}) return image;
  const ShadedScene scene(*world_, state);
  const int side = static_cast<int>(std::lround(std::sqrt(world_->settings.samples_per_pixel)));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      for (int s = 0; s < side * side; ++s) {
        const double x_px = x + (s % side + 0.5) / side, y_px = y + (s / side + 0.5) / side;
        const auto ray_key = static_cast<std::uint64_t>((y * width + x) * side * side + s);
        sum += scene.radiance_along(direction_in_camera(x_px, y_px), ray_key);
      }
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(sum[c] / (side * side));
    }
  });
  return image;
}

}  // namespace lumitexel
