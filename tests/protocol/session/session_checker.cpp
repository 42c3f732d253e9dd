#include "tests/protocol/session/session_checker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>

#include "drivers/error.h"
#include "rig/frame_file.h"
#include "rig/lighting.h"
#include "rig/sha256.h"
#include "rig/whole_file.h"
#include "sim/state_strip.h"

namespace lumitexel {
namespace {

// An axis within its tolerance of 0.01 degrees has arrived; strip and registers round to 0.001.
constexpr double kArrived_deg = 0.0111, kSamePlace_deg = 0.0021;
constexpr double kSameExposure_s = 0.6e-9, kSameGain_db = 0.6e-3;  // the strip's rounding

constexpr std::array<const char*, 8> kNames{"lost",     "duplicated", "unreadable", "settings",
                                            "position", "lamps",      "key",        "record"};

bool same_in_strip(const CameraSettings& strip, const CameraSettings& wanted) {
  return std::abs(strip.exposure_s - wanted.exposure_s) <= kSameExposure_s &&
         std::abs(strip.gain_db - wanted.gain_db) <= kSameGain_db;
}

struct Place {
  double turntable_deg, light_azimuth_deg, light_elevation_deg;
};

// Written so that NaN is far from everything.
bool near(const Place& a, const Place& b, double most_deg) {
  return std::abs(std::remainder(a.turntable_deg - b.turntable_deg, 360.0)) <= most_deg &&
         std::abs(a.light_azimuth_deg - b.light_azimuth_deg) <= most_deg &&
         std::abs(a.light_elevation_deg - b.light_elevation_deg) <= most_deg;
}

std::ostream& operator<<(std::ostream& out, const CameraSettings& settings) {
  return out << settings.exposure_s << " s " << settings.gain_db << " dB";
}
std::ostream& operator<<(std::ostream& out, const Place& place) {
  return out << place.turntable_deg << '/' << place.light_azimuth_deg << '/' << place.light_elevation_deg << " deg";
}

template <class Shown, class Wanted>
std::string differ(const char* shows, const Shown& shown, const char* says, const Wanted& wanted) {
  std::ostringstream text;
  text << shows << ' ' << shown << ", " << says << ' ' << wanted;
  return text.str();
}

class Checker {
 public:
  explicit Checker(const SessionStore& session) : session_(session) {
    for (const Shot& shot : session.shots()) shots_[shot.id] = shot;
    check_.shots = static_cast<std::int64_t>(shots_.size());
  }

  SessionCheck run() {
    for (const FrameRecord& frame : session_.frames()) {
      ++check_.frames;
      if (!seen_.insert(frame.shot_id).second) report(Wrong::Duplicated, frame, "a second frame of the shot");
      check_frame(frame);
    }
    for (const auto& [id, shot] : shots_) {
      if (!seen_.contains(id)) check_.wrong.push_back({Wrong::Lost, id, "no frame"});
    }
    return std::move(check_);
  }

 private:
  void report(Wrong how, const FrameRecord& frame, const std::string& text) {
    check_.wrong.push_back({how, frame.shot_id, frame.name + ": " + text});
  }

  void check_frame(const FrameRecord& record) {
    const auto shot = shots_.find(record.shot_id);
    if (shot == shots_.end()) return report(Wrong::Key, record, "of no shot");
    try {
      const std::string bytes = read_whole_file(session_.frame_path(record));
      if (sha256_hex(bytes) != record.sha256) return report(Wrong::Unreadable, record, "its bytes have changed");
      const Frame frame = decode_frame_file(bytes, record.name);
      const auto strip = read_state_strip(frame.samples, frame.bits);
      if (!strip) return report(Wrong::Unreadable, record, "no state strip in its pixels");
      check_against_shot(record, shot->second, *strip);
      check_against_journal(record, *strip);
      const auto [first, is_new] = exposures_.emplace(strip->exposure_count, record.shot_id);
      if (!is_new) report(Wrong::Duplicated, record, differ("exposure", first->first, "is also shot", first->second));
    } catch (const Error& error) {
      report(Wrong::Unreadable, record, error.what());
    }
  }

  void check_against_shot(const FrameRecord& record, const Shot& shot, const StateStrip& strip) {
    if (!same_in_strip(strip.settings, shot.camera)) {
      report(Wrong::Settings, record, differ("taken with", strip.settings, "asked for", shot.camera));
    }
    const Place wanted{shot.turntable_deg, shot.light_azimuth_deg, shot.light_elevation_deg};
    if (!near(place_of(strip), wanted, kArrived_deg)) {
      report(Wrong::Position, record, differ("taken at", place_of(strip), "asked for", wanted));
    }
    const Lighting lit{strip.state.point_light, strip.state.ring_flash, strip.state.backlight};
    if (lit != lighting_of(shot.kind)) report(Wrong::Lamps, record, "other lamps than its kind wants");
    if (strip.frame_key != static_cast<std::uint64_t>(shot.id)) {
      report(Wrong::Key, record, differ("pixels of frame", strip.frame_key, "asked for", shot.id));
    }
  }

  void check_against_journal(const FrameRecord& record, const StateStrip& strip) {
    for (const CameraSettings& said : {record.applied, record.reported}) {
      if (same_in_strip(strip.settings, said)) continue;
      report(Wrong::Record, record, differ("taken with", strip.settings, "journal", said));
    }
    const Place said{record.turntable_deg, record.light_azimuth_deg, record.light_elevation_deg};
    if (!near(place_of(strip), said, kSamePlace_deg)) {
      report(Wrong::Record, record, differ("taken at", place_of(strip), "journal", said));
    }
    const Shot& shot = shots_.at(record.shot_id);
    if (record.role != to_string(shot.kind)) report(Wrong::Record, record, "journal calls it " + record.role);
  }

  static Place place_of(const StateStrip& strip) {
    return {strip.state.turntable_deg, strip.state.light_azimuth_deg, strip.state.light_elevation_deg};
  }

  const SessionStore& session_;
  std::map<std::int64_t, Shot> shots_;
  std::set<std::int64_t> seen_;
  std::map<std::uint64_t, std::int64_t> exposures_;
  SessionCheck check_;
};

}  // namespace

const char* to_string(Wrong wrong) { return kNames.at(static_cast<std::size_t>(wrong)); }

int SessionCheck::count(Wrong how) const {
  return static_cast<int>(
      std::count_if(wrong.begin(), wrong.end(), [how](const WrongFrame& frame) { return frame.how == how; }));
}

int SessionCheck::mislabelled() const {
  std::set<std::int64_t> shots_wrong;
  for (const WrongFrame& frame : wrong) {
    if (frame.how != Wrong::Lost && frame.how != Wrong::Duplicated) shots_wrong.insert(frame.shot_id);
  }
  return static_cast<int>(shots_wrong.size());
}

std::string SessionCheck::text() const {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, wrong.size()); ++i) {
    const WrongFrame& frame = wrong[i];
    text += std::string(to_string(frame.how)) + ": shot " + std::to_string(frame.shot_id) + ": " + frame.text + '\n';
  }
  if (wrong.size() > kShown) text += "and " + std::to_string(wrong.size() - kShown) + " more\n";
  return text;
}

SessionCheck check_session(const SessionStore& session) { return Checker(session).run(); }

}  // namespace lumitexel
