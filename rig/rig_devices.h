// The devices of one rig, connected: hardware, simulated or recorded alike.
#pragma once

#include <memory>

#include "drivers/camera.h"
#include "drivers/clock.h"
#include "drivers/light.h"
#include "drivers/motion.h"
#include "rig/safety_lane.h"
#include "rig/stage_hand.h"

namespace lumitexel {

struct RigDevices {
  std::shared_ptr<Clock> clock;
  std::unique_ptr<Camera> camera;
  std::unique_ptr<Axis> turntable, light_azimuth, light_elevation;
  std::unique_ptr<Lamp> point_light, ring_flash, backlight;
  // Empty where an operator does it: the sequencer then pauses and says what to put where (rig/sequencer.h).
  std::unique_ptr<StageHand> stage;
  // Empty for rigs that can hurt nobody: simulated in process, recorded.
  std::unique_ptr<SafetyLane> safety;
};

}  // namespace lumitexel
