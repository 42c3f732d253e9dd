#include "rig/commission/commission_rig.h"

#include <typeinfo>

#include "drivers/error.h"
#include "rig/commission/motion_checks.h"
#include "rig/commission/sensor_checks.h"
#include "rig/commission/timing_checks.h"
#include "rig/guarded_run.h"

namespace lumitexel {
namespace {

// About a pixel or two of motion near the table's rim for a bench whose picture is filled by the object; a moved light
// changes a picture much less.
constexpr double kTableStep_deg = 0.25, kLightStep_deg = 1.0, kSwing_deg = 10.0;

const char* const kNeverChecked[] = {
    "the exposure times' absolute scale: that takes a light source timed by another clock",
    "the absolute radiance scale and the lens: the gray card and `lumitexel calibrate` tell those",
    "the light's true position against the arm's angles: `lumitexel calibrate` tells it per view",
    "what happens on a power cut, on a door opened and on the emergency switch: do that by hand",
};

class Commissioning {
 public:
  Commissioning(RigDevices& devices, const RigDescription& rig, Progress& progress, std::stop_token stop)
      : devices_(devices), bench_(devices, rig, std::move(stop)), progress_(progress) {}

  CommissionReport run() {
    progress_.begin("commissioning", 5, "checks");
    attempt("settings latency", [&] { report_.timing = check_latency(bench_); });
    progress_.update(1);
    attempt("sensor", [&] { report_.sensor = check_sensor(bench_); });
    if (report_.sensor && !report_.sensor->full_well_e) {
      report_.not_checked.push_back("the full well: no exposure of this camera saturates the picture under the point light");
    }
    progress_.update(2);
    bench_.light_only(devices_.point_light.get());
    check(*devices_.turntable, kTableStep_deg);
    check(*devices_.light_azimuth, kLightStep_deg);
    check(*devices_.light_elevation, kLightStep_deg);
    progress_.update(4);
    check_clock(bench_, report_.timing);
    if (!report_.timing.clock_drift_ppm) {
      report_.not_checked.push_back("the camera's clock against this machine's: the frames took too short a time in all");
    }
    report_.not_checked.insert(report_.not_checked.end(), std::begin(kNeverChecked), std::end(kNeverChecked));
    progress_.update(5);
    return report_;
  }

 private:
  void check(Axis& axis, double step_deg) {
    attempt(axis.name(), [&] { report_.axes.push_back(check_axis(bench_, axis, step_deg, kSwing_deg)); });
  }

  // A plain Error is the scene's; a device's fault has a type of its own and ends the commissioning.
  void attempt(const std::string& what, const std::function<void()>& check) {
    try {
      check();
    } catch (const Error& error) {
      if (typeid(error) != typeid(Error) && typeid(error) != typeid(OutOfRange)) throw;
      report_.not_checked.push_back(what + ": " + error.what());
    }
  }

  RigDevices& devices_;
  TestBench bench_;
  Progress& progress_;
  CommissionReport report_;
};

}  // namespace

RigDescription commissioning_description(RigDescription rig) {
  rig.turntable.settle_s = 0.0;
  rig.light_positioner.settle_s = 0.0;
  rig.camera.limits.settings_latency_frames = 0;
  return rig;
}

CommissionReport commission_rig(RigDevices& devices, const RigDescription& rig, Progress& progress,
                                std::stop_token stop) {
  GuardedRun guard(devices, stop);
  const double start_s = devices.clock->now_s();
  try {
    CommissionReport report = Commissioning(devices, rig, progress, guard.stop()).run();
    guard.finish();
    report.seconds = devices.clock->now_s() - start_s;
    return report;
  } catch (const std::exception& error) {
    guard.rethrow_or_explain(guard.abandon(error.what()));
  }
}

}  // namespace lumitexel
