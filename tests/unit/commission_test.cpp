// What commissioning finds out about rigs whose flaws are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "drivers/error.h"
#include "fake_rig.h"
#include "rig/commission/commission_rig.h"
#include "rig/commission/frame_statistics.h"
#include "rig/commission/image_displacement.h"
#include "rig/commission/measured_rig.h"
#include "rig/progress.h"
#include "rig/rig_file.h"
#include "sim/seeded_random.h"
#include "sim/simulated_bench.h"
#include "sim/simulated_rig.h"
#include "simulated_bench.h"
#include "temporary_folder.h"

namespace lumitexel {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kBacklash_deg = 0.1, kSwing_deg = 0.4;

// Measured once for all tests below: it takes some seconds.
const CommissionReport& report_of_a_worn_rig() {
  static const CommissionReport report = [] {
    SimulationSettings settings = plain_settings();
    settings.turntable_backlash_deg = kBacklash_deg;
    settings.turntable_swing_deg = kSwing_deg;
    settings.turntable_swing_decay_s = 0.15;
    const RigDescription rig = small_bench();
    RigDevices devices = make_simulated_devices(make_rendered_bench(
        commissioning_description(rig), small_world(rig, settings), std::make_shared<VirtualClock>()));
    NoProgress progress;
    return commission_rig(devices, rig, progress, {});
  }();
  return report;
}

void expect_within(const Measured& measured, double truth, double sigmas = 4.0) {
  EXPECT_NEAR(measured.value, truth, sigmas * measured.sigma);
}

TEST(Commission, FindsTheSensorsFigures) {
  const SensorFindings& sensor = report_of_a_worn_rig().sensor.value();
  expect_within(sensor.electrons_per_dn, 1.2);
  expect_within(sensor.read_noise_e, 4.0);
  expect_within(sensor.black_level_dn, 256.0, 6.0);  // at 10 microseconds a hot pixel or two still shows
  EXPECT_NEAR(sensor.full_well_e.value().value, 18000.0, 0.01 * 18000.0);
  EXPECT_NEAR(sensor.dark_current_e_per_s.value, 2.0 * std::exp2(5.0 / 7.0), 0.1);
  EXPECT_LT(sensor.nonlinearity_percent, 0.2);
  EXPECT_LT(sensor.lamp_instability_percent, 0.2);
  // And not so wide that anything would fit.
  EXPECT_LT(sensor.electrons_per_dn.sigma, 0.03);
  EXPECT_LT(sensor.read_noise_e.sigma, 0.1);
}

TEST(Commission, FindsTheTablesSlackAndHowLongItSwings) {
  const AxisFindings& table = report_of_a_worn_rig().axes.at(0);
  EXPECT_EQ(table.axis, "turntable");
  expect_within(table.backlash, kBacklash_deg, 2.0);
  EXPECT_LT(table.backlash.sigma, 0.1 * kBacklash_deg);
  // 0.4 degrees fall below the axis's tolerance of 0.01 after 0.55 s, by looks some 0.1 s apart.
  EXPECT_NEAR(table.settle_s, 0.55, 0.2);
}

TEST(Commission, FindsNoSlackWhereThereIsNone) {
  const std::vector<AxisFindings>& axes = report_of_a_worn_rig().axes;
  ASSERT_EQ(axes.size(), 3u) << testing::PrintToString(report_of_a_worn_rig().not_checked);
  for (std::size_t i : {1, 2}) {
    EXPECT_LT(axes[i].backlash.value, 4.0 * axes[i].backlash.sigma) << axes[i].axis;
    EXPECT_EQ(axes[i].settle_s, 0.0) << axes[i].axis;
  }
}

TEST(Commission, SaysWhatItCouldNotCheck) {
  EXPECT_THAT(report_of_a_worn_rig().not_checked, Contains(HasSubstr("absolute radiance scale")));
}

TEST(Commission, ItsDescriptionIsARigThatBuildsOnTheOther) {
  const TemporaryFolder folder;
  const std::filesystem::path base = std::filesystem::path(LUMITEXEL_SOURCE_DIR) / "config/rigs/simulated.toml";
  const RigDescription rig = parse_rig(read_rig_file(base), "base");
  CommissionReport report = report_of_a_worn_rig();
  report.timing.settings_latency_frames = 3;
  std::ofstream(folder / "measured.toml") << measured_rig_toml(report, rig, base.string());
  const RigDescription measured = parse_rig(read_rig_file(folder / "measured.toml"), "measured");
  EXPECT_EQ(measured.camera.limits.settings_latency_frames, 3);
  EXPECT_NEAR(measured.camera.sensor.electrons_per_dn, report.sensor->electrons_per_dn.value, 1e-5);
  EXPECT_NEAR(measured.turntable.settle_s, 1.2 * report.axes[0].settle_s, 1e-5);
  EXPECT_EQ(measured.camera.lens.focal_x_px, rig.camera.lens.focal_x_px);
}

// A camera whose settings land late: its pixels' brightness is exposure, whatever it reports.
class LateCamera final : public Camera {
 public:
  LateCamera(std::shared_ptr<Clock> clock, int late, bool honest)
      : clock_(std::move(clock)), history_(static_cast<std::size_t>(late) + 1, 0.01), honest_(honest) {}
  std::string name() const override { return "late camera"; }
  CameraLimits limits() const override {
    CameraLimits limits = small_bench().camera.limits;
    limits.width_px = limits.height_px = 16;
    return limits;
  }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token) override { return armed_ = settings; }
  Frame trigger(std::uint64_t, std::stop_token stop) override {
    clock_->sleep_until(clock_->now_s() + 0.1, stop);
    history_.push_back(armed_.exposure_s);
    history_.erase(history_.begin());
    Frame frame;
    frame.width_px = frame.height_px = 16;
    frame.bits = 14;
    frame.mosaic = limits().mosaic;
    frame.samples.assign(256, static_cast<std::uint16_t>(256.0 + std::min(16000.0, 1e6 * history_.front())));
    frame.reported = {honest_ ? history_.front() : armed_.exposure_s, armed_.gain_db};
    frame.device_frame_id = ++count_;
    frame.device_time_s = clock_->now_s();
    return frame;
  }

 private:
  std::shared_ptr<Clock> clock_;
  std::vector<double> history_;
  bool honest_;
  CameraSettings armed_;
  std::uint64_t count_ = 0;
};

TEST(Commission, TellsHowLateSettingsLandAlsoOfACameraThatLies) {
  for (const bool honest : {true, false}) {
    for (int late = 0; late <= 5; ++late) {
      const RigDescription rig = small_bench();
      const auto bench = std::make_shared<FakeBench>();
      RigDevices devices = make_fake_devices(rig, bench);
      devices.camera = std::make_unique<LateCamera>(devices.clock, late, honest);
      NoProgress progress;
      const CommissionReport report = commission_rig(devices, rig, progress, {});
      EXPECT_EQ(report.timing.settings_latency_frames.value(), late) << (honest ? "honest" : "lying");
      EXPECT_EQ(report.timing.honest_late_frames, honest ? late : 0);
      // A picture without noise or detail shows neither gain nor motion, and that is said.
      EXPECT_THAT(report.not_checked, Contains(HasSubstr("photon transfer")));
      EXPECT_THAT(report.not_checked, Contains(HasSubstr("turntable: only 0 pixels change")));
    }
  }
}

TEST(PhotonTransfer, RecoversTheGainOfSyntheticNoise) {
  for (const double electrons_per_dn : {0.1, 1.0, 30.0}) {
    std::vector<std::uint16_t> first, second;
    for (std::uint64_t i = 0; i < 200000; ++i) {
      CounterRandom random(17, i);
      const double electrons = 20000.0 * electrons_per_dn * static_cast<double>(i) / 200000.0;
      const auto draw = [&] {
        return static_cast<std::uint16_t>(std::lround(
            std::max(0.0, 500.0 + (random.poisson(electrons) + 5.0 * random.normal()) / electrons_per_dn)));
      };
      first.push_back(draw());
      second.push_back(draw());
    }
    const PhotonTransfer fit = fit_photon_transfer(noise_groups(first, second, 500.0, 20000.0, 20));
    EXPECT_NEAR(fit.electrons_per_dn.value, electrons_per_dn,
                4.0 * fit.electrons_per_dn.sigma + 0.01 * electrons_per_dn);
  }
}

TEST(Displacement, FlatPicturesCannotShowMotion) {
  const std::vector<float> flat(1000, 300.0f), variance(1000, 9.0f);
  EXPECT_THROW(DisplacementGauge(flat, flat, 0.25, 4, variance), Error);
}

}  // namespace
}  // namespace lumitexel
