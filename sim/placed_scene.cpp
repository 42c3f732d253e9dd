#include "sim/placed_scene.h"

#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
// Analytic parts are met in double at a metre's scale: this keeps a ray from meeting the part that it starts on.
constexpr double kStartOffset_m = 1e-9;

}  // namespace

PlacedScene::PlacedScene(const SimulatedWorld& world, double turntable_deg, bool with_tags)
    : world_(world), mesh_from_rig_(world.mesh_from_rig(turntable_deg)) {
  for (const Eigen::Vector3d& centre : world.sphere_centres_in_rig()) spheres_.push_back(mesh_from_rig_ * centre);

  const GrayCardDescription& card = world.rig.gray_card;
  card_.centre = mesh_from_rig_ * card.centre_in_rig;
  card_.normal = mesh_from_rig_.linear() * card.normal_in_rig.normalized();
  const Eigen::Vector3d wanted_up = mesh_from_rig_.linear() * card.up_in_rig;
  card_.up = (wanted_up - card_.normal * card_.normal.dot(wanted_up)).normalized();
  card_.right = card_.up.cross(card_.normal);
  card_.half_width_m = card_.half_height_m = 0.5 * card.size_m;

  const Eigen::Isometry3d mesh_from_camera = mesh_from_rig_ * world.rig.camera.camera_from_rig.inverse();
  panel_.centre = mesh_from_camera * Eigen::Vector3d(0, 0, world.settings.backlight_distance_m);
  panel_.right = mesh_from_camera.linear().col(0);
  panel_.up = -mesh_from_camera.linear().col(1);
  panel_.normal = -mesh_from_camera.linear().col(2);
  panel_.half_width_m = 0.5 * world.settings.backlight_size_m.x();
  panel_.half_height_m = 0.5 * world.settings.backlight_size_m.y();

  if (!with_tags) return;
  for (const TagDescription& tag : world.rig.tags) tags_.push_back(placed_tag(tag));
}

PlacedScene::Square PlacedScene::placed_tag(const TagDescription& tag) const {
  const Eigen::Isometry3d mesh_from_tags = tag.on_table ? world_.table_from_mesh.inverse() : mesh_from_rig_;
  Square square;
  square.centre = mesh_from_tags * tag.centre;
  square.normal = mesh_from_tags.linear() * tag.normal;
  square.up = mesh_from_tags.linear() * tag.up;
  square.right = square.up.cross(square.normal);
  square.half_width_m = square.half_height_m = TagPattern::kHalfExtent * tag.size_m;
  return square;
}

double PlacedScene::Square::distance_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const double approach = normal.dot(direction);
  if (approach == 0.0) return kNone;
  const double distance = normal.dot(centre - origin) / approach;
  if (!(distance > kStartOffset_m)) return kNone;
  const Eigen::Vector3d inside = origin + distance * direction - centre;
  const bool met = std::abs(inside.dot(right)) <= half_width_m && std::abs(inside.dot(up)) <= half_height_m;
  return met ? distance : kNone;
}

double PlacedScene::sphere_distance(std::size_t sphere, const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d to_centre = spheres_[sphere] - origin;
  const double along = to_centre.dot(direction), radius = world_.rig.spheres.radius_m;
  const double reach_sq = radius * radius - (to_centre - along * direction).squaredNorm();
  if (reach_sq <= 0.0) return kNone;
  const double distance = along - std::sqrt(reach_sq);
  return distance > kStartOffset_m ? distance : kNone;
}

void PlacedScene::complete_object_hit(const RayHit& hit, SceneHit& result) const {
  const auto& [a, b, c] = world_.object.triangles[hit.triangle];
  const std::vector<Eigen::Vector3d>& x = world_.object.positions;
  const std::vector<Eigen::Vector3d>& n = world_.object.normals;
  const double w = 1.0 - hit.u - hit.v;
  result.point = w * x[a] + hit.u * x[b] + hit.v * x[c];
  result.normal = (w * n[a] + hit.u * n[b] + hit.v * n[c]).normalized();
  result.facet = (x[b] - x[a]).cross(x[c] - x[a]).normalized();
}

SceneHit PlacedScene::closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  SceneHit result;
  result.distance_m = kNone;
  if (const auto hit = world_.object_rays.closest(origin, direction)) {
    result.part = ScenePart::Object;
    result.distance_m = hit->distance_m;
    complete_object_hit(*hit, result);
  }
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const double distance = sphere_distance(i, origin, direction);
    if (distance < result.distance_m) {
      const Eigen::Vector3d point = origin + distance * direction;
      const Eigen::Vector3d normal = (point - spheres_[i]).normalized();
      result = {ScenePart::Sphere, distance, point, normal, normal};
    }
  }
  for (const auto& [square, part] : {std::pair{&card_, ScenePart::GrayCard}, {&panel_, ScenePart::Backlight}}) {
    const double distance = square->distance_along(origin, direction);
    if (distance < result.distance_m) {
      result = {part, distance, origin + distance * direction, square->normal, square->normal};
    }
  }
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    const double distance = tags_[i].distance_along(origin, direction);
    if (distance < result.distance_m) {
      result = {ScenePart::Tag, distance, origin + distance * direction, tags_[i].normal, tags_[i].normal, i};
    }
  }
  return result;
}

double PlacedScene::tag_albedo(const SceneHit& hit, const Eigen::Vector3d& across, const Eigen::Vector3d& down) const {
  constexpr int kSamples = 34, kStride = 21;  // a Fibonacci lattice: fine along rows and columns alike
  const Square& square = tags_[hit.tag];
  const double size_m = world_.rig.tags[hit.tag].size_m;
  const auto in_sizes = [&](const Eigen::Vector3d& x) -> Eigen::Vector2d {
    return Eigen::Vector2d(x.dot(square.right), x.dot(square.up)) / size_m;
  };
  const Eigen::Vector2d middle = in_sizes(hit.point - square.centre), right = in_sizes(across), below = in_sizes(down);
  int white = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double u = (i + 0.5) / kSamples - 0.5, v = (i * kStride % kSamples + 0.5) / kSamples - 0.5;
    white += world_.tag_patterns[hit.tag].white_at(middle + u * right + v * below) ? 1 : 0;
  }
  return kPrintedBlack + (kTagWhite - kPrintedBlack) * white / kSamples;
}

bool PlacedScene::shadowed(const SceneHit& hit, const Eigen::Vector3d& light) const {
  const double distance = (light - hit.point).norm();
  const Eigen::Vector3d direction = (light - hit.point) / distance;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    if (sphere_distance(i, hit.point, direction) < distance) return true;
  }
  if (hit.part != ScenePart::GrayCard && card_.distance_along(hit.point, direction) < distance) return true;
  return world_.object_rays.occluded(hit.point, direction, world_.object_rays.surface_offset_m(), distance);
}

}  // namespace lumitexel
