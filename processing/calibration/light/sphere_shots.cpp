#include "processing/calibration/light/sphere_shots.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "processing/calibration/lens/larger_pixels.h"
#include "processing/calibration/light/ring_row.h"
#include "processing/image/binned_mosaic.h"

namespace lumitexel {
namespace {

EmitterDisc lamp_of(const RigDescription& rig) {
  return {rig.light_positioner.lamp_radius_m, rig.camera.camera_from_rig * rig.light_positioner.pivot_in_rig};
}

// An arm set up with care is off its description by centimetres; what stands farther away is some other light.
constexpr double kReachOfRadius = 0.25;
constexpr double kMostOfRadius = 0.2;  // a lamp's: as the rig's file may have it

// The file's, unless two sigmas contradict it.
double lamp_radius_by(const LampSize& size, double in_file_m) {
  if (!size.measured) return in_file_m;
  constexpr double kSigmas = 2.0, kOneInTwenty = 1.645;
  if (size.resolved) return std::abs(in_file_m - size.radius_m) <= kSigmas * size.sigma_m ? in_file_m : size.radius_m;
  // The bound goes with the square root of its sigmas, at most: g(0) itself may be above zero.
  return in_file_m <= std::sqrt(kSigmas / kOneInTwenty) * size.upper_m ? in_file_m : 0.0;
}

// Highlights are looked for and fitted at the scale that all of this is made for, spheres of 40 to 80 px radius: a highlight is a share of
// its sphere, whatever the pixels. Even, for a mosaic of colours (binned_mosaic.h).
int block_of(const CameraModel& camera, const RigDescription& rig) {
  constexpr double kLeastRadiusPx = 40.0;
  const double distance_m = (rig.camera.camera_from_rig * rig.light_positioner.pivot_in_rig).norm();
  const double radius_px = camera.focal_x_px * rig.spheres.radius_m / distance_m;
  return std::max(1, 2 * static_cast<int>(radius_px / (2.0 * kLeastRadiusPx)));
}

// In the pixels of the picture itself. Blocks of a mosaic of colours are its green alone.
void scale(std::vector<HighlightPixel>& highlights, int block, Mosaic mosaic) {
  const bool green_alone = block > 1 && mosaic != Mosaic::Mono;
  for (HighlightPixel& highlight : highlights) {
    highlight.pixel *= block;
    highlight.sigma_px *= block;
    for (double& flux : highlight.flux) flux *= block * block;
    if (green_alone) highlight.flux[0] = highlight.flux[2] = 0.0;
  }
}

LampHighlights lamp_highlights(const PointHighlights& points, const LightSolution& solution, const RigDescription& rig) {
  LampHighlights lamp{points.seen, {}, lamp_of(rig).faces, kMostOfRadius * rig.light_positioner.radius_m};
  for (const MeasuredLight& light : solution.lights) {
    lamp.lights.push_back(light.measured ? std::optional(light.position) : std::nullopt);
  }
  return lamp;
}

}  // namespace

SphereHighlights read_sphere_highlights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                                        const CameraModel& full_camera, const RigDescription& rig, Progress& progress) {
  const int block = block_of(full_camera, rig);
  const CameraModel camera = with_larger_pixels(full_camera, block);
  std::atomic<std::int64_t> done{0};
  std::function<void()> step = [&] { progress.update(++done); };
  progress.begin("sphere shots", static_cast<std::int64_t>(2 * views.size()), "shots");
  const PictureOf ring = [&](std::size_t v) { return binned(reader.read(views[v].ring), block); };
  const PictureOf point = [&](std::size_t v) { return binned(reader.read(views[v].point), block); };
  const LightPositionerDescription& arm = rig.light_positioner;
  ExpectedLights expected{{}, kReachOfRadius * arm.radius_m, lamp_of(rig)};
  for (const SphereShots& view : views) {
    expected.positions.push_back(rig.camera.camera_from_rig *
                       arm.nominal_position_in_rig(view.point.light_azimuth_deg, view.point.light_elevation_deg));
  }
  const RingRow row = read_ring_row(views.size(), ring, camera, rig, step);
  const PointWidths widths = measure_point_widths(views.size(), ring, camera, row.line, row.rings, rig.ring_flash.radius_m);
  SphereHighlights seen;
  // Of a large lamp taken for a point some highlights cannot be fitted: with its radius known, once more.
  constexpr int kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    PointHighlights points = read_point_highlights(point, camera, row.line, expected, step);
    step = [] {};  // the progress has counted every shot once
    const LightSolution solution = solve_lights(camera, row.line, rig.ring_flash.radius_m, row.rings, points.own, expected.lamp);
    const LampSize size = measure_lamp_size(widths, point, camera, row.line,
                                            lamp_highlights(points, solution, rig));
    seen = {row.rings, std::move(points.own), std::move(points.strays), row.line, expected.lamp, size};
    const double radius_m = lamp_radius_by(size, arm.lamp_radius_m);
    if (std::abs(radius_m - expected.lamp.radius_m) <= size.sigma_m) break;
    expected.lamp.radius_m = radius_m;
  }
  const Mosaic mosaic = rig.camera.limits.mosaic;
  scale(seen.rings, block, mosaic);
  for (std::vector<HighlightPixel>& view : seen.points) scale(view, block, mosaic);
  for (auto& view : seen.strays) {
    for (std::vector<HighlightPixel>& stray : view) scale(stray, block, mosaic);
  }
  return seen;
}

LightSolution measure_lights(const SphereHighlights& seen, const CameraModel& camera, const RigDescription& rig,
                             const std::optional<LensMatrix>& lens_covariance) {
  return solve_lights(camera, seen.line, rig.ring_flash.radius_m, seen.rings, seen.points, seen.lamp, lens_covariance);
}

}  // namespace lumitexel
