// Devices with their guards taken out, to prove that the checker of sessions sees what the guards keep away. For tests
// alone: each wraps the real driver and believes what it should not.
#pragma once

#include <memory>

#include "rig/rig_devices.h"

namespace lumitexel {

// Takes whatever frame comes for the one asked for: reports, names, numbers and dates it so that the base objects to
// nothing.
std::unique_ptr<Camera> without_guard(std::unique_ptr<Camera> camera);
// Says that it stands at its target as soon as it has been sent there.
std::unique_ptr<Axis> without_guard(std::unique_ptr<Axis> axis, const std::shared_ptr<Clock>& clock);
// Says that it shines as soon as it has been told to.
std::unique_ptr<Lamp> without_guard(std::unique_ptr<Lamp> lamp, const std::shared_ptr<Clock>& clock);

}  // namespace lumitexel
