// What Camera::shoot() promises, whatever the driver under it does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "drivers/camera.h"
#include "drivers/error.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;

CameraLimits small_limits() {
  CameraLimits limits;
  limits.width_px = 4;
  limits.height_px = 2;
  limits.bits = 12;
  limits.exposure_min_s = 1e-5;
  limits.exposure_max_s = 10.0;
  limits.exposure_step_s = 1e-6;
  limits.gain_min_db = 0.0;
  limits.gain_max_db = 24.0;
  limits.gain_step_db = 0.1;
  return limits;
}

// Delivers good frames, but for what the script says about the next triggers and arms.
class ScriptedCamera final : public Camera {
 public:
  explicit ScriptedCamera(CameraLimits limits = small_limits()) : limits_(std::move(limits)) {
    on_discard([this](const DiscardedFrame& frame) { discarded.push_back(frame); });
  }
  std::string name() const override { return "scripted camera"; }
  CameraLimits limits() const override { return limits_; }

  std::deque<std::function<void(Frame&)>> triggers;  // may throw
  std::function<CameraSettings(CameraSettings)> applies = [](CameraSettings settings) { return settings; };
  std::function<void()> on_recover = [] {};
  int arms = 0, frames = 0, recoveries = 0;
  std::vector<DiscardedFrame> discarded;

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token) override {
    ++arms;
    return armed_ = applies(settings);
  }
  Frame trigger(std::uint64_t frame_key, std::stop_token) override {
    Frame frame;
    frame.width_px = limits_.width_px;
    frame.height_px = limits_.height_px;
    frame.bits = limits_.bits;
    frame.samples.assign(8, 7);
    frame.reported = armed_;
    frame.device_frame_id = static_cast<std::uint64_t>(++frames);
    frame.device_time_s = frames;
    frame.echoed_key = frame_key;
    if (!triggers.empty()) {
      const auto change = triggers.front();
      triggers.pop_front();
      change(frame);
    }
    return frame;
  }
  void recover(std::stop_token) override {
    ++recoveries;
    on_recover();
  }

 private:
  CameraLimits limits_;
  CameraSettings armed_;
};

constexpr CameraSettings kAsked{0.01, 6.0};

TEST(CameraContract, AGoodFrameIsTakenAtOnce) {
  ScriptedCamera camera;
  const Frame frame = camera.shoot(kAsked, {}, 5);
  EXPECT_EQ(frame.frame_key, 5u);
  EXPECT_EQ(camera.frames, 1);
  EXPECT_TRUE(camera.discarded.empty());
}

struct Flaw {
  const char* name;
  std::function<void(Frame&)> change;
  const char* cause;
};

class FlawedFrame : public testing::TestWithParam<Flaw> {};

TEST_P(FlawedFrame, IsDiscardedAndShotAgain) {
  ScriptedCamera camera;
  camera.shoot(kAsked, {}, 1);
  camera.triggers.push_back(GetParam().change);
  const Frame frame = camera.shoot(kAsked, {}, 2);
  EXPECT_EQ(camera.frames, 3);
  EXPECT_EQ(frame.device_frame_id, 3u);
  ASSERT_EQ(camera.discarded.size(), 1u);
  EXPECT_EQ(camera.discarded[0].frame_key, 2u);
  EXPECT_THAT(camera.discarded[0].cause, HasSubstr(GetParam().cause));
  EXPECT_EQ(camera.recoveries, 0);
}

TEST_P(FlawedFrame, IsNeverDeliveredHoweverOftenItComes) {
  ScriptedCamera camera;
  camera.shoot(kAsked, {}, 1);
  camera.triggers.assign(3, GetParam().change);
  try {
    camera.shoot(kAsked, {}, 2);
    FAIL() << "a flawed frame was delivered";
  } catch (const Protocol& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("scripted camera"), HasSubstr(GetParam().cause)));
  }
  EXPECT_EQ(camera.discarded.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(
    Every, FlawedFrame,
    testing::Values(Flaw{"LateExposure", [](Frame& f) { f.reported.exposure_s = 0.02; }, "the frame reports 0.02 s"},
                    Flaw{"LateGain", [](Frame& f) { f.reported.gain_db = 0.0; }, "the frame reports 0.01 s, 0 dB"},
                    Flaw{"NotANumber", [](Frame& f) { f.reported.exposure_s = NAN; }, "reports nan"},
                    Flaw{"Narrow", [](Frame& f) { f.width_px = 3; }, "3 x 2 pixels"},
                    Flaw{"Shallow", [](Frame& f) { f.bits = 8; }, "8 bits"},
                    Flaw{"OtherMosaic", [](Frame& f) { f.mosaic = Mosaic::Rggb; }, "rggb"},
                    Flaw{"Incomplete", [](Frame& f) { f.samples.pop_back(); }, "7 samples"},
                    Flaw{"SomebodyElses", [](Frame& f) { f.echoed_key = 1; }, "the frame named 1"},
                    Flaw{"DeliveredBefore", [](Frame& f) { f.device_frame_id = 1; }, "delivered before"},
                    Flaw{"FromThePast", [](Frame& f) { f.device_time_s = 1.0; }, "on the camera's clock"},
                    Flaw{"WithoutTime", [](Frame& f) { f.device_time_s = NAN; }, "on the camera's clock"}),
    [](const auto& one) { return one.param.name; });

TEST(CameraContract, AnAttemptThatFailsIsRepeatedAfterRecovering) {
  for (const std::function<void(Frame&)>& fault :
       {std::function<void(Frame&)>([](Frame&) { throw Timeout("no frame"); }),
        std::function<void(Frame&)>([](Frame&) { throw Disconnected("gone"); }),
        std::function<void(Frame&)>([](Frame&) { throw Protocol("packets missing"); })}) {
    ScriptedCamera camera;
    camera.triggers.push_back(fault);
    EXPECT_EQ(camera.shoot(kAsked, {}).samples.size(), 8u);
    EXPECT_EQ(camera.recoveries, 1);
    EXPECT_EQ(camera.arms, 2);  // every setting anew
    ASSERT_EQ(camera.discarded.size(), 1u);
    EXPECT_FALSE(camera.discarded[0].reported.has_value());
  }
}

TEST(CameraContract, AFaultThatStaysIsThrownAsWhatItIs) {
  ScriptedCamera camera;
  camera.triggers.push_back([](Frame&) { throw Timeout("no frame"); });
  camera.on_recover = [] { throw Disconnected("scripted camera: not found any more"); };
  EXPECT_THROW(camera.shoot(kAsked, {}), Disconnected);
  EXPECT_EQ(camera.recoveries, 2);
}

TEST(CameraContract, AFullCardOrACancelIsNotRepeated) {
  ScriptedCamera camera;
  camera.triggers.push_back([](Frame&) { throw StorageFull("card full"); });
  EXPECT_THROW(camera.shoot(kAsked, {}), StorageFull);
  EXPECT_EQ(camera.frames, 1);
  camera.triggers.push_back([](Frame&) { throw Cancelled("stop"); });
  EXPECT_THROW(camera.shoot(kAsked, {}), Cancelled);
  EXPECT_EQ(camera.frames, 2);
}

TEST(CameraContract, WhatACancelledShotLeftOnItsWayMeetsNoLaterShot) {
  ScriptedCamera camera;
  camera.shoot(kAsked, {});
  camera.triggers.push_back([](Frame&) { throw Cancelled("stop"); });
  EXPECT_THROW(camera.shoot(kAsked, {}), Cancelled);
  EXPECT_EQ(camera.recoveries, 0);
  camera.shoot(kAsked, {});
  EXPECT_EQ(camera.recoveries, 1);
  camera.shoot(kAsked, {});
  EXPECT_EQ(camera.recoveries, 1);
}

TEST(CameraContract, SettingsThatDoNotStickNeverReachTheTrigger) {
  ScriptedCamera camera;
  camera.applies = [](CameraSettings settings) { return CameraSettings{settings.exposure_s * 1.01, settings.gain_db}; };
  EXPECT_THROW(camera.shoot(kAsked, {}), Protocol);
  EXPECT_EQ(camera.frames, 0);
  // Another unit's rounding is not another setting.
  camera.applies = [](CameraSettings settings) {
    return CameraSettings{static_cast<double>(static_cast<float>(settings.exposure_s)), settings.gain_db};
  };
  EXPECT_NO_THROW(camera.shoot({1.0 / 3.0, 6.0}, {}));
}

TEST(CameraContract, FramesThatMayBeLateAreDroppedUnseenAfterAChangeOnly) {
  CameraLimits limits = small_limits();
  limits.settings_latency_frames = 2;
  ScriptedCamera camera(limits);
  camera.shoot(kAsked, {});
  EXPECT_EQ(camera.frames, 3);
  camera.shoot(kAsked, {});
  EXPECT_EQ(camera.frames, 4);
  camera.shoot({0.02, 6.0}, {});
  EXPECT_EQ(camera.frames, 7);
}

TEST(CameraContract, ARebootedCameraMayCountAndKeepTimeAnew) {
  ScriptedCamera camera;
  for (int i = 0; i < 3; ++i) camera.shoot(kAsked, {});
  camera.triggers.push_back([](Frame&) { throw Disconnected("rebooted"); });
  camera.on_recover = [&] { camera.frames = 0; };
  EXPECT_EQ(camera.shoot(kAsked, {}).device_time_s, 1.0);
}

TEST(Quantise, AnswersAreFixedPointsAndTheNearest) {
  const CameraLimits limits = small_limits();
  for (const double wanted_s : {1e-5, 1.23456789e-5, 0.1, 1.0 / 3.0, 10.0}) {
    const CameraSettings once = quantise({wanted_s, 1.23}, limits, "camera");
    EXPECT_EQ(quantise(once, limits, "camera"), once);
    EXPECT_NEAR(once.exposure_s, wanted_s, 0.5e-6 + 1e-15);
    EXPECT_NEAR(once.gain_db, 1.2, 1e-12);
  }
}

TEST(Quantise, ADialsExposuresAreTheNearestInStops) {
  CameraLimits limits = small_limits();
  limits.exposure_choices_s = {0.001, 0.01, 0.1, 1.0};
  EXPECT_EQ(quantise({0.03, 0.0}, limits, "camera").exposure_s, 0.01);   // 1.6 stops off, not 1.7
  EXPECT_EQ(quantise({0.033, 0.0}, limits, "camera").exposure_s, 0.1);
  EXPECT_EQ(quantise({0.1, 0.0}, limits, "camera").exposure_s, 0.1);
}

TEST(Quantise, WhatLiesOutsideIsRefused) {
  const CameraLimits limits = small_limits();
  for (const CameraSettings& wanted : {CameraSettings{1e-6, 0.0}, CameraSettings{11.0, 0.0}, CameraSettings{NAN, 0.0},
                                       CameraSettings{0.1, -0.1}, CameraSettings{0.1, 24.1}, CameraSettings{0.1, NAN}}) {
    EXPECT_THROW(quantise(wanted, limits, "camera"), OutOfRange);
  }
}

}  // namespace
}  // namespace lumitexel
