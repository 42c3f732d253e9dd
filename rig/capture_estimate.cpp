#include "rig/capture_estimate.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "rig/motion_time.h"
#include "rig/raw_frame_file.h"

namespace lumitexel {
namespace {

std::vector<RigPosition> distinct_positions(const std::vector<Shot>& shots) {
  std::vector<RigPosition> positions;
  for (const Shot& shot : shots) {
    const RigPosition position = position_of(shot);
    if (std::find(positions.begin(), positions.end(), position) == positions.end()) positions.push_back(position);
  }
  return positions;
}

// Prim's algorithm.
double spanning_tree_s(const std::vector<RigPosition>& positions, const RigDescription& rig) {
  std::vector<double> distance_s(positions.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> joined(positions.size(), false);
  double sum_s = 0.0;
  if (!positions.empty()) distance_s[0] = 0.0;
  for (std::size_t step = 0; step < positions.size(); ++step) {
    std::size_t next = positions.size();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!joined[i] && (next == positions.size() || distance_s[i] < distance_s[next])) next = i;
    }
    joined[next] = true;
    sum_s += distance_s[next];
    for (std::size_t i = 0; i < positions.size(); ++i) {
      distance_s[i] = std::min(distance_s[i], fastest_motion_s(positions[next], positions[i], rig));
    }
  }
  return sum_s;
}

}  // namespace

CaptureEstimate estimate_capture(const std::vector<Shot>& shots, const RigDescription& rig) {
  CaptureEstimate estimate;
  RigPosition position;
  std::optional<CameraSettings> settings;
  const int late = rig.camera.limits.settings_latency_frames;  // frames dropped after a change
  for (const Shot& shot : shots) {
    estimate.exposure_s += shot.camera.exposure_s;
    estimate.readout_s += rig.camera.limits.readout_s;
    estimate.motion_s += sequential_motion_s(position, position_of(shot), rig);
    estimate.bytes += pgm_bytes(rig.camera.limits);
    if (settings != shot.camera) {
      estimate.exposure_s += late * shot.camera.exposure_s;
      estimate.readout_s += late * rig.camera.limits.readout_s;
    }
    settings = shot.camera;
    position = position_of(shot);
  }
  estimate.shortest_motion_s = spanning_tree_s(distinct_positions(shots), rig);
  estimate.estimate_s = estimate.exposure_s + estimate.readout_s + estimate.motion_s;
  estimate.lower_bound_s = estimate.exposure_s + estimate.readout_s + estimate.shortest_motion_s;
  return estimate;
}

}  // namespace lumitexel
