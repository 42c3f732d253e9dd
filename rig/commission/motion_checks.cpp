#include "rig/commission/motion_checks.h"

#include <algorithm>
#include <cmath>

#include "rig/commission/image_displacement.h"

namespace lumitexel {
namespace {

constexpr int kReferenceFrames = 4, kReturns = 6;
constexpr double kLongRest_s = 3.0;
// Settling is looked at so long after the encoder's arrival, one look per return.
constexpr double kLooks_s[] = {0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.2, 1.6};
constexpr double kStill_sigmas = 4.0, kClear_sigmas = 5.0;

class AxisCheck {
 public:
  AxisCheck(TestBench& bench, Axis& axis, double step, double swing)
      : bench_(bench), axis_(axis), step_(step), swing_(swing), home_(home_of(axis, step + swing)),
        exposure_s_(bench.exposure_for(0.5)) {}

  AxisFindings run() {
    AxisFindings found;
    found.axis = axis_.name();
    DisplacementGauge gauge = calibrated(found);
    check_backlash(gauge, found);
    // A second time by a step of the slack's own size: there the picture's change is what is looked for.
    if (found.backlash.value > kClear_sigmas * found.backlash.sigma && found.backlash.value < 0.7 * step_) {
      step_ = found.backlash.value;
      gauge = calibrated(found);
      check_backlash(gauge, found);
    }
    check_settling(gauge, found);
    axis_.move_to(home_, bench_.stop());
    return found;
  }

 private:
  // Where it stands, or as near to that as leaves room on both sides.
  static double home_of(const Axis& axis, double room) {
    const AxisLimits limits = axis.limits();
    if (limits.wraps || limits.max - limits.min < 2.0 * room) return axis.position();
    return std::clamp(axis.position(), limits.min + room, limits.max - room);
  }

  // Always from the same side, so that slack does not enter.
  std::vector<std::vector<std::uint16_t>> pictures_at(double position) {
    axis_.move_to(position - swing_, bench_.stop());
    axis_.move_to(position, bench_.stop());
    rest(kLongRest_s);
    std::vector<std::vector<std::uint16_t>> frames;
    for (int i = 0; i < kReferenceFrames; ++i) frames.push_back(bench_.settled_shot(exposure_s_).samples);
    return frames;
  }

  DisplacementGauge calibrated(AxisFindings& found) {
    const auto reference = pictures_at(home_), stepped = pictures_at(home_ + step_);
    const std::vector<float> mean = mean_picture(reference);
    DisplacementGauge gauge(mean, mean_picture(stepped), step_, kReferenceFrames, variances(mean));
    found.resolution = gauge.resolution();
    return gauge;
  }

  // By the described noise model; check_sensor tells how well that holds.
  std::vector<float> variances(const std::vector<float>& mean) const {
    const SensorDescription& sensor = bench_.rig().camera.sensor;
    const double read_dn = sensor.read_noise_e / sensor.electrons_per_dn;
    std::vector<float> result;
    for (const float dn : mean) {
      const double signal_dn = std::max(0.0, dn - sensor.black_level_dn);
      result.push_back(static_cast<float>(read_dn * read_dn + kQuantisation_dn2 + signal_dn / sensor.electrons_per_dn));
    }
    return result;
  }

  double look(const DisplacementGauge& gauge) { return gauge.displacement(bench_.settled_shot(exposure_s_).samples); }

  void check_backlash(const DisplacementGauge& gauge, AxisFindings& found) {
    std::vector<double> from_below, differences;
    for (int i = 0; i < kReturns; ++i) {
      axis_.move_to(home_ - swing_, bench_.stop());
      axis_.move_to(home_, bench_.stop());
      rest(kLongRest_s);
      from_below.push_back(look(gauge));
      axis_.move_to(home_ + swing_, bench_.stop());
      axis_.move_to(home_, bench_.stop());
      rest(kLongRest_s);
      differences.push_back(look(gauge) - from_below.back());
    }
    double mean = 0.0;
    for (const double difference : differences) mean += difference / kReturns;
    const double chance = std::max(deviation_of(differences), std::sqrt(2.0) * found.resolution) / std::sqrt(kReturns);
    found.backlash = {std::abs(mean), std::hypot(chance, kCurvature * mean)};
    found.repeatability = deviation_of(from_below);
  }

  void check_settling(const DisplacementGauge& gauge, AxisFindings& found) {
    for (const double look_s : kLooks_s) {
      axis_.move_to(home_ - swing_, bench_.stop());
      rest(kLongRest_s);
      axis_.move_to(home_, bench_.stop());
      rest(look_s);
      found.settling.push_back({look_s + 0.5 * exposure_s_, look(gauge)});
    }
    const double still = std::max(kStill_sigmas * found.resolution, axis_.limits().tolerance);
    const double rest_place = found.settling.back().y;
    double settled_s = 0.0;
    for (std::size_t i = 0; i + 1 < found.settling.size(); ++i) {
      if (std::abs(found.settling[i].y - rest_place) > still) settled_s = found.settling[i + 1].x;
    }
    found.settle_s = settled_s;
  }

  void rest(double time_s) {
    Clock& clock = *bench_.devices().clock;
    clock.sleep_until(clock.now_s() + time_s, bench_.stop());
  }

  TestBench& bench_;
  Axis& axis_;
  double step_, swing_, home_, exposure_s_;
};

}  // namespace

AxisFindings check_axis(TestBench& bench, Axis& axis, double step, double swing) {
  return AxisCheck(bench, axis, step, swing).run();
}

}  // namespace lumitexel
