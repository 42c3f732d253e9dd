#include "rig/commission/timing_checks.h"

#include <algorithm>
#include <cmath>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kChanges = 6, kFramesAfterChange = 8;
constexpr double kShortest_s = 20.0;  // of a run, for its drift to mean anything

// Frames after the change that were taken with the earlier exposure, whether discarded or delivered.
int late_after_change(TestBench& bench, double exposure_s, double level, double other_level, int& honest) {
  bench.forget_late_frames();
  int late = 0;
  for (int i = 0; i < kFramesAfterChange; ++i) {
    const double mean = mean_of(bench.shoot(exposure_s).samples);
    if (std::abs(mean - other_level) < std::abs(mean - level)) late = i + 1;
  }
  honest = std::max(honest, bench.late_frames());
  return late + bench.late_frames();
}

// The level once the settings must have landed.
double steady_level(TestBench& bench, double exposure_s) {
  for (int i = 0; i < kFramesAfterChange; ++i) bench.shoot(exposure_s);
  return mean_of(bench.shoot(exposure_s).samples);
}

}  // namespace

TimingFindings check_latency(TestBench& bench) {
  TimingFindings found;
  bench.light_only(bench.devices().point_light.get());
  bench.set_latency(kFramesAfterChange);  // not known yet
  const double bright_s = bench.exposure_for(0.6);
  const double dim_s = std::max(bright_s / 4.0, bench.devices().camera->limits().exposure_min_s);
  if (bright_s < 2.0 * dim_s) throw Error("the scene is so bright that two exposures cannot be told apart; dim the point light");
  const double bright = steady_level(bench, bright_s), dim = steady_level(bench, dim_s);
  int latest = 0;
  for (int i = 0; i < kChanges; ++i) {
    const bool to_bright = i % 2 == 0;
    const int late = late_after_change(bench, to_bright ? bright_s : dim_s, to_bright ? bright : dim,
                                       to_bright ? dim : bright, found.honest_late_frames);
    latest = std::max(latest, late);
  }
  found.settings_latency_frames = latest;
  bench.set_latency(latest);
  return found;
}

void check_clock(const TestBench& bench, TimingFindings& found) {
  std::vector<double> overheads;
  for (const TimedFrame& frame : bench.frames()) overheads.push_back(frame.arrived_s - frame.shot_s - frame.exposure_s);
  // Clocks are compared on the quicker half: what held up the others says nothing of them.
  const double quick_s = median_of(overheads);
  std::vector<CurvePoint> clocks;
  for (std::size_t i = 0; i < overheads.size(); ++i) {
    const TimedFrame& frame = bench.frames()[i];
    if (overheads[i] <= quick_s) clocks.push_back({frame.arrived_s, frame.device_s - frame.arrived_s});
  }
  found.frame_overhead_s = {median_of(overheads), deviation_of(overheads) / std::sqrt(double(overheads.size()))};
  found.slowest_overhead_s = *std::max_element(overheads.begin(), overheads.end());
  if (clocks.back().x - clocks.front().x < kShortest_s) return;
  const Line line = fit_line(clocks);
  found.clock_drift_ppm = Measured{1e6 * line.slope.value, 1e6 * line.slope.sigma};
  found.clock_jitter_s = line.residual_sigma;
}

}  // namespace lumitexel
