#include "tests/unit/recorded_session.h"

#include <iomanip>
#include <sstream>

#include "drivers/error.h"
#include "rig/new_session.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "rig/sha256.h"
#include "rig/whole_file.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

std::ostream& operator<<(std::ostream& out, const CameraSettings& settings) {
  return out << settings.exposure_s << ' ' << settings.gain_db;
}

}  // namespace

void RecordedSession::capture(const Misbehaviour& misbehaviour) {
  const RigDescription rig = small_rig();
  SessionStore store =
      std::filesystem::exists(path())
          ? SessionStore::open(path(), OpenMode::ReadWrite)
          : begin_session(path(), {{{"rig.toml", small_rig_toml()}, {"plan.toml", small_plan_toml()}},
                                   schedule_shots(small_plan(), rig, "plan.toml"),
                                   [](const std::filesystem::path& folder) {
                                     std::filesystem::create_directory(folder / "truth");
                                     write_whole_file(folder / "truth" / "calibration.json", "{}");
                                   }});
  const auto bench = std::make_shared<FakeBench>();
  int trigger = 0;
  bench->before_exposure = [&] {
    ++trigger;
    if (misbehaviour.before_exposure) misbehaviour.before_exposure(trigger);
  };
  bench->tamper = [&](Frame& frame) {
    frame.sensor_temperature_c = 20.0 + trigger;
    bench->light_azimuth_deg += 0.001;  // so that readings are not just what was asked
    if (misbehaviour.tamper) misbehaviour.tamper(trigger, frame);
  };
  RigDevices devices = make_fake_devices(rig, bench);
  NoProgress progress;
  try {
    take_missing_shots(store, devices, progress, {});
  } catch (const Error&) {
    // As it was meant to be; what was taken is in the journal.
  }
}

std::shared_ptr<const SessionStore> RecordedSession::open() const {
  return std::make_shared<const SessionStore>(SessionStore::open(path(), OpenMode::ReadOnly));
}

std::vector<std::string> frame_lines(const SessionStore& session) {
  std::vector<std::string> lines;
  for (const FrameRecord& frame : session.frames()) {
    std::ostringstream line;
    line << std::setprecision(17) << frame.id << ' ' << frame.shot_id << ' ' << frame.name << ' ' << frame.role << ' '
         << frame.sha256 << ' ' << sha256_hex(read_whole_file(session.frame_path(frame))) << ' ' << frame.bytes << ' '
         << frame.requested << ' ' << frame.applied << ' ' << frame.reported << ' ' << frame.utc_ns << ' '
         << frame.device_time_s << ' ' << frame.sensor_temperature_c << ' ' << frame.turntable_deg << ' '
         << frame.light_azimuth_deg << ' ' << frame.light_elevation_deg;
    lines.push_back(line.str());
  }
  return lines;
}

std::vector<std::string> discard_lines(const SessionStore& session) {
  std::vector<std::string> lines;
  for (const DiscardRecord& discard : session.discards()) {
    std::ostringstream line;
    line << std::setprecision(17) << discard.shot_id << ' ' << discard.attempt << ' ' << discard.asked << ' ';
    if (discard.reported) line << *discard.reported << ' ';
    line << discard.cause << ' ' << discard.utc_ns;
    lines.push_back(line.str());
  }
  return lines;
}

}  // namespace lumitexel
