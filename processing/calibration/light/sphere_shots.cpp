#include "processing/calibration/light/sphere_shots.h"

#include <atomic>

#include "processing/calibration/light/point_highlights.h"
#include "processing/calibration/light/ring_row.h"

namespace lumitexel {
namespace {

EmitterDisc lamp_of(const RigDescription& rig) {
  return {rig.light_positioner.lamp_radius_m, rig.camera.camera_from_rig * rig.light_positioner.pivot_in_rig};
}

// An arm set up with care is off its description by centimetres; what stands farther away is some other light.
constexpr double kReachOfRadius = 0.25;

}  // namespace

SphereHighlights read_sphere_highlights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                                        const CameraModel& camera, const RigDescription& rig, Progress& progress) {
  std::atomic<std::int64_t> done{0};
  const auto step = [&] { progress.update(++done); };
  progress.begin("sphere shots", static_cast<std::int64_t>(2 * views.size()), "shots");
  const RecordOf ring = [&](std::size_t v) -> const FrameRecord& { return views[v].ring; };
  const RecordOf point = [&](std::size_t v) -> const FrameRecord& { return views[v].point; };
  const LightPositionerDescription& arm = rig.light_positioner;
  ExpectedLights expected{{}, kReachOfRadius * arm.radius_m, lamp_of(rig)};
  for (const SphereShots& view : views) {
    expected.positions.push_back(rig.camera.camera_from_rig *
                       arm.nominal_position_in_rig(view.point.light_azimuth_deg, view.point.light_elevation_deg));
  }
  const RingRow row = read_ring_row(views.size(), reader, ring, camera, rig, step);
  PointHighlights points = read_point_highlights(reader, point, camera, row.line, expected, step);
  return {row.rings, std::move(points.own), std::move(points.strays), row.line};
}

LightSolution measure_lights(const SphereHighlights& seen, const CameraModel& camera, const RigDescription& rig,
                             const std::optional<LensMatrix>& lens_covariance) {
  return solve_lights(camera, seen.line, rig.ring_flash.radius_m, seen.rings, seen.points, lamp_of(rig), lens_covariance);
}

}  // namespace lumitexel
