#include "rig/verify_session.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "drivers/error.h"
#include "rig/motion_time.h"
#include "rig/frame_file.h"
#include "rig/rig_description.h"
#include "rig/sequencer.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

std::string shown(const CameraSettings& settings) {
  std::ostringstream text;
  text << settings.exposure_s << " s, " << settings.gain_db << " dB";
  return text.str();
}

class Verifier {
 public:
  Verifier(const SessionStore& session, Progress& progress) : session_(session), progress_(progress) {}

  SessionVerdict run() {
    check_journal();
    check_documents();
    check_frames();
    check_missing();
    check_unjournalled();
    return std::move(verdict_);
  }

 private:
  void problem(const std::string& file, const std::string& what) { verdict_.problems.push_back({file, what}); }

  void check_journal() {
    for (const std::string& what : session_.journal_problems()) problem("session.db", what);
  }

  void check_documents() {
    for (const std::string& name : session_.document_names()) {
      try {
        session_.document(name);
      } catch (const Corrupt& error) {
        problem("session.db", error.what());
      }
    }
    if (session_.kind() != SessionKind::Captured) return;
    try {
      camera_ = parse_rig(session_.document("rig.toml"), "rig.toml").camera.limits;
    } catch (const Error& error) {
      problem("session.db", std::string("the rig's description cannot be read: ") + error.what());
    }
  }

  void check_frames() {
    const std::vector<FrameRecord> frames = session_.frames();
    for (const Shot& shot : session_.shots()) shots_[shot.id] = shot;
    verdict_.frames = static_cast<std::int64_t>(frames.size());
    progress_.begin("verifying", verdict_.frames, "frames");
    for (const FrameRecord& frame : frames) {
      journalled_.insert(frame.name);
      if (const std::optional<std::string> bytes = check_bytes(frame)) check_against_shot(frame, *bytes);
      progress_.update(static_cast<std::int64_t>(journalled_.size()));
    }
  }

  // The file's bytes if they are the ones that were committed.
  std::optional<std::string> check_bytes(const FrameRecord& frame) {
    const std::string file = "frames/" + frame.name;
    std::ifstream in(session_.frame_path(frame), std::ios::binary);
    if (!in || !fs::is_regular_file(session_.frame_path(frame))) {
      problem(file, "is missing or cannot be read");
      return std::nullopt;
    }
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (static_cast<std::int64_t>(bytes.size()) != frame.bytes) {
      problem(file, "has " + std::to_string(bytes.size()) + " bytes, committed were " + std::to_string(frame.bytes));
      return std::nullopt;
    }
    if (sha256_hex(bytes) != frame.sha256) {
      problem(file, "its bytes do not match the hash in the journal");
      return std::nullopt;
    }
    return bytes;
  }

  void check_against_shot(const FrameRecord& frame, const std::string& bytes) {
    if (session_.kind() != SessionKind::Captured) return;
    const std::string file = "frames/" + frame.name;
    const auto shot = shots_.find(frame.shot_id);
    if (shot == shots_.end()) return problem(file, "belongs to no shot");
    if (frame.role != to_string(shot->second.kind)) {
      problem(file, "is a " + frame.role + ", its shot is a " + to_string(shot->second.kind));
    }
    check_settings(file, frame, shot->second);
    check_position(file, frame, shot->second);
    check_image(file, bytes);
  }

  void check_settings(const std::string& file, const FrameRecord& frame, const Shot& shot) {
    if (frame.requested == shot.camera && frame.applied == shot.camera && same_settings(frame.reported, shot.camera)) return;
    problem(file, "its shot wants " + shown(shot.camera) + "; requested " + shown(frame.requested) + ", applied " +
                      shown(frame.applied) + ", reported " + shown(frame.reported));
  }

  void check_position(const std::string& file, const FrameRecord& frame, const Shot& shot) {
    const auto check = [&](const char* axis, double distance_deg, double wanted_deg, double was_deg) {
      if (distance_deg <= kAxisTolerance_deg) return;
      std::ostringstream text;
      text << axis << " stood at " << was_deg << " deg, its shot wants " << wanted_deg << " deg";
      problem(file, text.str());
    };
    check("turntable", turn_between_deg(frame.turntable_deg, shot.turntable_deg), shot.turntable_deg,
          frame.turntable_deg);
    check("light azimuth", std::abs(frame.light_azimuth_deg - shot.light_azimuth_deg), shot.light_azimuth_deg,
          frame.light_azimuth_deg);
    check("light elevation", std::abs(frame.light_elevation_deg - shot.light_elevation_deg), shot.light_elevation_deg,
          frame.light_elevation_deg);
  }

  void check_image(const std::string& file, const std::string& bytes) {
    try {
      const Frame image = decode_frame_file(bytes, file);
      if (!camera_) return;  // reported once already
      if (image.width_px != camera_->width_px || image.height_px != camera_->height_px ||
          image.bits != camera_->bits || image.mosaic != camera_->mosaic) {
        problem(file, "its image header does not fit the rig's camera");
      }
    } catch (const Corrupt& error) {
      problem(file, error.what());
    }
  }

  void check_missing() {
    for (const Shot& shot : session_.missing_shots()) {
      problem("frames/" + frame_file_name(shot),
              "shot " + std::to_string(shot.id) + " (" + to_string(shot.kind) + (shot.view.empty() ? "" : " of ") +
                  shot.view + ") was never taken");
    }
  }

  void check_unjournalled() {
    const fs::path folder = session_.directory() / "frames";
    if (!fs::is_directory(folder)) return problem("frames", "the folder is missing");
    std::set<std::string> unknown;  // sorted: a folder's own order is arbitrary
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (!journalled_.contains(name)) unknown.insert(name);
    }
    for (const std::string& name : unknown) problem("frames/" + name, "is not in the journal");
  }

  const SessionStore& session_;
  Progress& progress_;
  SessionVerdict verdict_;
  std::optional<CameraLimits> camera_;
  std::map<std::int64_t, Shot> shots_;
  std::set<std::string> journalled_;
};

}  // namespace

SessionVerdict verify_session(const SessionStore& session, Progress& progress) {
  return Verifier(session, progress).run();
}

}  // namespace lumitexel
