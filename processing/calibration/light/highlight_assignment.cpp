#include "processing/calibration/light/highlight_assignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Highlights = std::vector<HighlightPixel>;

struct Candidate {
  Eigen::Vector3d light;
  std::vector<std::size_t> members;  // indices into the highlights
  double misfit_px2 = 0;

  bool better_than(const Candidate& other) const {
    if (members.size() != other.members.size()) return members.size() > other.members.size();
    return misfit_px2 < other.misfit_px2;
  }
};

// The nearest highlight on every sphere, if within the tolerance.
Candidate company_of(const CameraModel& camera, const SphereLine& line, const Highlights& seen,
                     const Eigen::Vector3d& light, double tolerance_px) {
  Candidate candidate{light, {}, 0.0};
  for (int k = 0; k < line.count; ++k) {
    const Eigen::Vector2d expected = highlight_pixel(camera, line.sphere(k), light);
    double nearest2 = tolerance_px * tolerance_px;
    std::optional<std::size_t> member;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double distance2 = (seen[i].pixel - expected).squaredNorm();
      if (seen[i].sphere != k || !(distance2 < nearest2)) continue;
      nearest2 = distance2;
      member = i;
    }
    if (!member) continue;
    candidate.members.push_back(*member);
    candidate.misfit_px2 += nearest2;
  }
  return candidate;
}

Highlights chosen(const Highlights& seen, const std::vector<std::size_t>& members) {
  Highlights result;
  for (const std::size_t i : members) result.push_back(seen[i]);
  return result;
}

std::optional<Candidate> best_candidate(const CameraModel& camera, const SphereLine& line, const Highlights& seen,
                                        double tolerance_px) {
  std::vector<std::optional<Ray>> rays;
  for (const HighlightPixel& h : seen) {
    rays.push_back(mirrored_ray(line.sphere(h.sphere), {Eigen::Vector3d::Zero(), camera.unproject(h.pixel)}));
  }
  std::optional<Candidate> best;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t j = i + 1; j < seen.size(); ++j) {
      if (!rays[i] || !rays[j] || seen[i].sphere == seen[j].sphere) continue;
      const auto light = nearest_point({*rays[i], *rays[j]});
      if (!light || !((*light - rays[i]->origin).dot(rays[i]->direction) > 0.0)) continue;
      // A pair's meeting point is coarse in its distance: the wide net first, then all of its company together.
      constexpr double kWide = 3.0;
      const Candidate wide = company_of(camera, line, seen, *light, kWide * tolerance_px);
      const auto together = light_from_highlights(camera, line, chosen(seen, wide.members));
      if (!together) continue;
      Candidate candidate = company_of(camera, line, seen, *together, tolerance_px);
      if (!best || candidate.better_than(*best)) best = std::move(candidate);
    }
  }
  return best;
}

}  // namespace

HighlightAssignment assign_highlights(const CameraModel& camera, const SphereLine& line, const Highlights& seen, int least,
                                      double tolerance_px) {
  const bool on_line = std::all_of(seen.begin(), seen.end(),
                                   [&](const HighlightPixel& h) { return h.sphere >= 0 && h.sphere < line.count; });
  if (least < 3 || !(tolerance_px > 0.0) || !on_line) {
    throw BadInput("highlight assignment",
                   std::to_string(least) + " highlights a light within " + std::to_string(tolerance_px) + " px",
                   "three or more, a positive tolerance, spheres of the line");
  }
  HighlightAssignment result;
  result.left_over = seen;
  while (true) {
    const auto best = best_candidate(camera, line, result.left_over, tolerance_px);
    if (!best || static_cast<int>(best->members.size()) < least) break;
    result.lights.push_back({best->light, chosen(result.left_over, best->members)});
    Highlights rest;
    for (std::size_t i = 0; i < result.left_over.size(); ++i) {
      if (std::find(best->members.begin(), best->members.end(), i) == best->members.end()) rest.push_back(result.left_over[i]);
    }
    result.left_over = std::move(rest);
  }
  return result;
}

}  // namespace lumitexel
