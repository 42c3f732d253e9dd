#include "processing/surface/best_view.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "processing/surface/triangle_adjacency.h"

namespace lumitexel {
namespace {

constexpr double kHiddenCornerPenalty = 0.1;   // a triangle seen in part counts a tenth
constexpr double kNeighbourBonus = 0.15;       // a neighbour in the same view is worth 15 % more pixels
constexpr int kSmoothingPasses = 4;

using Scores = std::vector<float>;  // [triangle * views + view], covered pixels; 0 = not seen

double projected_area_px(const View& view, const std::array<Eigen::Vector3d, 3>& corners) {
  std::array<Eigen::Vector2d, 3> pixel;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d in_camera = view.camera_from_world * corners[k];
    if (in_camera.z() <= 0.0) return 0.0;
    pixel[k] = view.camera.project(in_camera);
    if (!view.camera.contains(pixel[k])) return 0.0;
  }
  const Eigen::Vector2d a = pixel[1] - pixel[0], b = pixel[2] - pixel[0];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

bool sees(const RayScene& scene, const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
  const Eigen::Vector3d to_eye = eye - point;
  const double distance = to_eye.norm();
  return !scene.occluded(point, to_eye / distance, scene.surface_offset_m(), distance);
}

float score(const View& view, const RayScene& scene, const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3.0;
  const Eigen::Vector3d facing = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const Eigen::Vector3d eye = view.camera_in_world();
  if (facing.dot(eye - centre) <= 0.0) return 0.0f;
  const double area = projected_area_px(view, corners);
  if (area <= 0.0 || !sees(scene, eye, centre)) return 0.0f;
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector3d inset = 0.9 * corner + 0.1 * centre;
    if (!sees(scene, eye, inset)) return static_cast<float>(kHiddenCornerPenalty * area);
  }
  return static_cast<float>(area);
}

Scores score_all(const CalibratedSession& session, const RayScene& scene) {
  const std::size_t views = session.views.size();
  Scores scores(session.mesh.triangles.size() * views, 0.0f);
  oneapi::tbb::parallel_for(std::size_t{0}, session.mesh.triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = session.mesh.triangles[t];
    const std::array<Eigen::Vector3d, 3> corners{session.mesh.positions[a], session.mesh.positions[b],
                                                 session.mesh.positions[c]};
    for (std::size_t v = 0; v < views; ++v) {
      if (!session.views[v].heldout) scores[t * views + v] = score(session.views[v], scene, corners);
    }
  });
  return scores;
}

int best_for(const Scores& scores, std::size_t views, std::size_t triangle, const std::array<int, 3>& neighbour_views) {
  int best = kUnseen;
  double best_score = 0.0;
  for (std::size_t v = 0; v < views; ++v) {
    int same = 0;
    for (const int view : neighbour_views) same += view == static_cast<int>(v);
    const double value = scores[triangle * views + v] * (1.0 + kNeighbourBonus * same);
    if (value > best_score) {
      best_score = value;
      best = static_cast<int>(v);
    }
  }
  return best;
}

}  // namespace

std::vector<int> choose_best_views(const CalibratedSession& session, const RayScene& scene) {
  const std::size_t triangles = session.mesh.triangles.size(), views = session.views.size();
  const Scores scores = score_all(session, scene);
  const auto adjacency = triangle_adjacency(session.mesh);
  std::vector<int> best(triangles, kUnseen);
  for (int pass = 0; pass <= kSmoothingPasses; ++pass) {
    const std::vector<int> before = best;  // so that the order of triangles does not matter
    for (std::size_t t = 0; t < triangles; ++t) {
      std::array<int, 3> neighbour_views{kUnseen, kUnseen, kUnseen};
      for (std::size_t k = 0; k < 3; ++k) {
        if (adjacency[t][k] != kNoNeighbour) neighbour_views[k] = before[adjacency[t][k]];
      }
      best[t] = best_for(scores, views, t, neighbour_views);
    }
  }
  return best;
}

}  // namespace lumitexel
