#include "sim/render_radiance.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "sim/board_picture.h"
#include "sim/placed_scene.h"
#include "sim/point_lamp.h"
#include "sim/seeded_random.h"
#include "sim/true_rig.h"

namespace lumitexel {
namespace {

// One world state made ready for shading; everything in the mesh's frame.
class ShadedScene {
 public:
  ShadedScene(const SimulatedWorld& world, const WorldState& state)
      : world_(world), state_(state),
        scene_(world, state.turntable_deg, !(state.backlight && world.settings.tags_clear_to_backlight)) {
    const Eigen::Isometry3d& mesh_from_rig = scene_.mesh_from_rig();
    mesh_from_camera_ = mesh_from_rig * world.rig.camera.camera_from_rig.inverse();
    for (const Emitter& emitter : point_lamp_in_rig(world, state.light_azimuth_deg, state.light_elevation_deg)) {
      point_light_.push_back(emitter.in(mesh_from_rig));
    }
    if ((world.settings.second_lamp_w_per_sr > 0.0).any()) {
      second_lamp_.push_back({mesh_from_rig * world.settings.second_lamp_in_rig_m, world.settings.second_lamp_w_per_sr});
    }
    for (const Emitter& emitter : ring_flash_in_rig(world)) ring_.push_back(emitter.in(mesh_from_rig));
    ray_spacing_ = 1.0 / std::sqrt(world.settings.samples_per_pixel);
    steel_ = {world.settings.sphere_roughness, world.settings.sphere_reflectance, Eigen::Array3d::Zero()};
  }

  // ray_key chooses among a lamp's emitters.
  Eigen::Array3d radiance_along(const Eigen::Vector3d& direction_in_camera, std::uint64_t ray_key) const {
    const Eigen::Vector3d direction = mesh_from_camera_.linear() * direction_in_camera;
    const SceneHit hit = scene_.closest(mesh_from_camera_.translation(), direction);
    if (hit.part == ScenePart::Nothing) return Eigen::Array3d::Zero();
    if (hit.part == ScenePart::Backlight) {
      return state_.backlight ? world_.settings.backlight_w_per_m2_sr : Eigen::Array3d::Zero();
    }
    const bool lit = state_.point_light || state_.ring_flash;
    if (!lit || hit.facet.dot(direction) >= 0.0) return Eigen::Array3d::Zero();
    const PatternPoint pattern = hit.part == ScenePart::Object ? world_.pattern.at(hit.point) : PatternPoint{};
    const double tag_albedo = hit.part == ScenePart::Tag ? tag_albedo_at(hit, direction, direction_in_camera.z()) : 0.0;
    const Surface surface{hit, pattern, tag_albedo};
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    if (state_.point_light) {
      sum += reflected_of(point_light_, surface, -direction, ray_key);
      if (!second_lamp_.empty()) sum += reflected(surface, -direction, second_lamp_.front());
    }
    if (state_.ring_flash) sum += reflected_of(ring_, surface, -direction, ray_key);
    return sum;
  }

 private:
  struct Surface {
    const SceneHit& hit;
    const PatternPoint& pattern;  // of the object
    double tag_albedo;            // of a tag, over the ray's share of its pixel
  };

  // depth_share: depth along the camera's axis over distance.
  double tag_albedo_at(const SceneHit& hit, const Eigen::Vector3d& direction, double depth_share) const {
    const double depth_m = hit.distance_m * depth_share;
    const auto on_tag = [&](Eigen::Index axis, double focal_px) -> Eigen::Vector3d {
      const Eigen::Vector3d step = mesh_from_camera_.linear().col(axis) * (ray_spacing_ * depth_m / focal_px);
      return step - direction * (hit.normal.dot(step) / hit.normal.dot(direction));
    };
    return scene_.tag_albedo(hit, on_tag(0, world_.camera.focal_x_px), on_tag(1, world_.camera.focal_y_px));
  }

  Eigen::Array3d brdf_at(const Surface& surface, const LobeGeometry& geometry) const {
    const auto diffuse = [](double albedo) -> Eigen::Array3d {
      return Eigen::Array3d::Constant(albedo / std::numbers::pi);
    };
    if (surface.hit.part == ScenePart::Sphere) return evaluate(steel_, geometry);
    if (surface.hit.part == ScenePart::GrayCard) return diffuse(world_.rig.gray_card.albedo);
    if (surface.hit.part == ScenePart::Tag) return diffuse(surface.tag_albedo);
    Eigen::Array3d f = Eigen::Array3d::Zero();
    for (std::size_t m = 0; m < world_.materials.size(); ++m) {
      if (surface.pattern.weight[m] > 0.0) {
        f += surface.pattern.weight[m] * evaluate(world_.materials[m], geometry, surface.pattern.albedo_scale);
      }
    }
    return f;
  }

  Eigen::Array3d reflected(const Surface& surface, const Eigen::Vector3d& wo, const Emitter& emitter) const {
    const SceneHit& hit = surface.hit;
    const Eigen::Vector3d to_light = emitter.position - hit.point;
    const double distance_sq = to_light.squaredNorm();
    const Eigen::Vector3d wi = to_light / std::sqrt(distance_sq);
    const LobeGeometry geometry = lobe_geometry(hit.normal, wi, wo);
    if (!(geometry.cos_i > 0.0 && geometry.cos_o > 0.0) || hit.facet.dot(wi) <= 0.0) return Eigen::Array3d::Zero();
    if (scene_.shadowed(hit, emitter.position)) return Eigen::Array3d::Zero();
    return brdf_at(surface, geometry) * emitter.intensity_along(-wi) * (geometry.cos_i / distance_sq);
  }

  // The spheres' highlights are images of the whole lamp, so they see all of it; for the rest, which a lamp of some
  // centimetres lights evenly, one emitter a ray is enough.
  Eigen::Array3d reflected_of(const std::vector<Emitter>& lamp, const Surface& surface, const Eigen::Vector3d& wo,
                              std::uint64_t ray_key) const {
    if (lamp.size() == 1) return reflected(surface, wo, lamp.front());
    if (surface.hit.part != ScenePart::Sphere) {
      const std::size_t chosen = scrambled(ray_key) % lamp.size();
      return static_cast<double>(lamp.size()) * reflected(surface, wo, lamp[chosen]);
    }
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (const Emitter& emitter : lamp) sum += reflected(surface, wo, emitter);
    return sum;
  }

  const SimulatedWorld& world_;
  WorldState state_;
  PlacedScene scene_;
  Eigen::Isometry3d mesh_from_camera_;
  std::vector<Emitter> point_light_, second_lamp_, ring_;
  double ray_spacing_ = 1.0;  // pixels
  GgxBrdf steel_;
};

// A lamp's place does not matter while it is dark; the states of all silhouettes of one angle are then one.
WorldState canonical(WorldState state) {
  state.lamp_strength = 1.0;
  state.sensor_warming_k = 0.0;
  if (state.flat_field) return {.flat_field = true};  // nothing else gets through the diffuser
  if (state.board != 0) {
    state.turntable_deg = 0.0;
    state.backlight = false;  // behind the board
    if (!state.point_light && !state.ring_flash) return {};
  }
  if (!state.point_light) state.light_azimuth_deg = state.light_elevation_deg = 0.0;
  if (!state.point_light && !state.ring_flash && !state.backlight) state.turntable_deg = 0.0;
  return state;
}

Image evenly_lit(const SimulatedWorld& world) {
  Image image(world.camera.width_px, world.camera.height_px, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(world.settings.flat_field_w_per_m2_sr[c]);
    }
  }
  return image;
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
  Image image;
  if (state == WorldState{}) {
    return Image(world_->camera.width_px, world_->camera.height_px, 3);
  } else if (state.flat_field) {
    image = evenly_lit(*world_);
  } else if (state.board != 0) {
    image = board_picture(*world_, state, corner_directions_);
  } else {
    image = render_scene(state);
  }
  if (world_->settings.vignetting != Eigen::Vector3d::Zero()) darken_corners(image);
  return image;
}

void RadianceRenderer::darken_corners(Image& image) const {
  tbb::parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const double share = vignetting_at(world_->rig.camera, world_->settings.vignetting, x + 0.5, y + 0.5);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(share * image.at(x, y, c));
    }
  });
}

Image RadianceRenderer::render_scene(const WorldState& state) const {
  const int width = world_->camera.width_px, height = world_->camera.height_px;
  Image image(width, height, 3);
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
