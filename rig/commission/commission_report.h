// What commissioning measured on a rig: each number with its one-sigma, and what could not be checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lumitexel {

struct Measured {
  double value = 0, sigma = 0;  // sigma: 0 where the value is a count
};

// One point of a curve that somebody will want to look at.
struct CurvePoint {
  double x = 0, y = 0;
};

struct SensorFindings {
  Measured black_level_dn;       // mean of the shortest darks
  Measured read_noise_dn;        // standard deviation of one read, quantisation taken out
  Measured electrons_per_dn;     // from the photon-transfer curve
  Measured read_noise_e;
  // Where a full exposure ends; both empty if none could be had.
  std::optional<Measured> saturation_dn, full_well_e;
  Measured dark_current_e_per_s;  // median pixel
  double hot_pixel_share = 0;     // pixels whose dark current is over ten times the frame's noise
  double nonlinearity_percent = 0;  // largest deviation from signal = slope * exposure, between 5 and 80 % of saturation
  double lamp_instability_percent = 0;  // standard deviation of the point light's mean signal from frame to frame
  std::vector<CurvePoint> linearity;        // exposure in s, deviation in percent
  std::vector<CurvePoint> photon_transfer;  // mean signal in DN, variance in DN^2
};

struct TimingFindings {
  std::optional<int> settings_latency_frames;  // frames after a change of exposure that still had the earlier one
  int honest_late_frames = 0;           // of these, frames that said so by themselves
  Measured frame_overhead_s;            // from trigger to frame, less the exposure: median
  double slowest_overhead_s = 0;
  std::optional<Measured> clock_drift_ppm;  // of the camera's clock against this machine's; empty over too short a time
  double clock_jitter_s = 0;            // standard deviation of the rest
};

struct AxisFindings {
  std::string axis;
  Measured backlash;                        // in the axis's unit
  double settle_s = 0;                      // from the encoder's arrival until the picture stands
  double repeatability = 0;                 // standard deviation of returning from the same side
  double resolution = 0;                    // what the pictures can tell apart: one sigma of a single look
  std::vector<CurvePoint> settling;         // s since arrival, displacement
};

struct CommissionReport {
  std::optional<SensorFindings> sensor;     // empty: the scene did not allow it
  TimingFindings timing;
  std::vector<AxisFindings> axes;
  std::vector<std::string> not_checked;     // one sentence each
  double seconds = 0;
};

}  // namespace lumitexel
