// A session that cannot go on ends with all lamps dark and all axes standing, whatever was lit or on its way.
#include <gtest/gtest.h>

#include <thread>

#include "drivers/error.h"
#include "rig/sequencer.h"
#include "tests/protocol/session/attended_capture.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

struct Begun {
  explicit Begun(const ProtocolRigOptions& options) : rig(options) {
    session.put_shots(synthetic_shots(2, rig.rig(), 1));
    devices = rig.connect();
  }
  TemporaryFolder folder;
  ProtocolRig rig;
  SessionStore session = SessionStore::create(folder / "session", SessionKind::Captured);
  RigDevices devices;
};

TEST(SafePause, OfACameraThatStaysSilentLeavesNoLampLit) {
  ProtocolRigOptions options;
  options.faults = std::make_shared<RandomFaults>(std::map<Fault, double>{{Fault::Wedge, 1.0}}, 1);
  Begun begun(options);
  NoProgress nobody;
  try {
    take_missing_shots(begun.session, begun.devices, nobody, {});
    FAIL() << "no frame ever came";
  } catch (const Timeout& error) {
    EXPECT_TRUE(begun.rig.is_at_rest());
    EXPECT_EQ(device_in(error.what()), "camera") << error.what();
  }
}

TEST(SafePause, OfTheUserLeavesNoAxisMoving) {
  ProtocolRigOptions options;
  options.speed_deg_per_s = 20.0;
  Begun begun(options);
  std::stop_source stop;
  const std::jthread user([&] {
    const SystemClock clock;
    const double give_up_s = clock.now_s() + 10.0;
    while (begun.rig.is_at_rest() && clock.now_s() < give_up_s) std::this_thread::yield();
    stop.request_stop();
  });
  NoProgress nobody;
  EXPECT_THROW(take_missing_shots(begun.session, begun.devices, nobody, stop.get_token()), Cancelled);
  EXPECT_TRUE(begun.rig.is_at_rest());
}

}  // namespace
}  // namespace lumitexel
