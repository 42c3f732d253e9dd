#include "rig/recording.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "drivers/error.h"
#include "rig/frame_file.h"
#include "rig/sequencer.h"
#include "rig/sha256.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using DiscardsByShot = std::map<std::int64_t, std::vector<DiscardRecord>>;

// The discards of one shot, parted into calls of shoot(): each counts its attempts from 1.
std::vector<RecordedShoot> shoots_of(const Shot& shot, const std::vector<DiscardRecord>& discards,
                                     const std::optional<FrameRecord>& frame) {
  std::vector<RecordedShoot> shoots;
  int last_attempt = std::numeric_limits<int>::max();
  for (const DiscardRecord& discard : discards) {
    if (discard.attempt <= last_attempt) shoots.push_back({shot, {}, std::nullopt});
    shoots.back().discards.push_back(discard);
    last_attempt = discard.attempt;
  }
  if (!frame) return shoots;
  // The frame came in the last of these calls, unless that one had used up its attempts.
  const bool of_last = !shoots.empty() && static_cast<int>(shoots.back().discards.size()) < kShotAttempts;
  if (!of_last) shoots.push_back({shot, {}, std::nullopt});
  shoots.back().frame = frame;
  return shoots;
}

// A camera that failed is connected anew, and its time may begin anew with that.
bool reconnected(const RecordedShoot& shoot) {
  return std::any_of(shoot.discards.begin(), shoot.discards.end(),
                     [](const DiscardRecord& discard) { return !discard.reported; });
}

class RunList {
 public:
  void add(const RecordedShoot& shoot) {
    if (ended_ || goes_back(shoot)) runs_.emplace_back();
    runs_.back().push_back(shoot);
    ended_ = !shoot.frame;
    if (shoot.frame) last_device_time_s_ = shoot.frame->device_time_s;
  }
  std::vector<RecordedRun> take() { return std::move(runs_); }

 private:
  bool goes_back(const RecordedShoot& shoot) const {
    return shoot.frame && !reconnected(shoot) && !(shoot.frame->device_time_s > last_device_time_s_);
  }
  std::vector<RecordedRun> runs_;
  bool ended_ = true;  // the last run, if any
  double last_device_time_s_ = -std::numeric_limits<double>::infinity();
};

// `wanted`: the shots to play; `discards`: theirs, in order.
std::vector<RecordedRun> runs_of(const SessionStore& recording, const std::map<std::int64_t, Shot>& wanted,
                                 const DiscardsByShot& discards) {
  const auto of_shot = [&](std::int64_t id) {
    const auto found = discards.find(id);
    return found == discards.end() ? std::vector<DiscardRecord>{} : found->second;
  };
  RunList list;
  std::set<std::int64_t> with_frame;
  for (const FrameRecord& frame : recording.frames()) {
    const auto shot = wanted.find(frame.shot_id);
    if (shot == wanted.end()) continue;
    with_frame.insert(frame.shot_id);
    for (const RecordedShoot& shoot : shoots_of(shot->second, of_shot(frame.shot_id), frame)) list.add(shoot);
  }
  // A shot that never succeeded was the last one tried: had a later one been taken, this one would have come before it.
  for (const auto& [id, shot] : wanted) {
    if (with_frame.contains(id)) continue;
    for (const RecordedShoot& shoot : shoots_of(shot, of_shot(id), std::nullopt)) list.add(shoot);
  }
  return list.take();
}

std::map<std::int64_t, Shot> by_id(const std::vector<Shot>& shots) {
  std::map<std::int64_t, Shot> map;
  for (const Shot& shot : shots) map.emplace(shot.id, shot);
  return map;
}

DiscardsByShot discards_of(const SessionStore& session) {
  DiscardsByShot discards;
  for (DiscardRecord& discard : session.discards()) discards[discard.shot_id].push_back(std::move(discard));
  return discards;
}

}  // namespace

std::vector<RecordedRun> recorded_runs(const SessionStore& recording) {
  const std::map<std::int64_t, Shot> shots = by_id(recording.shots());
  for (const FrameRecord& frame : recording.frames()) {
    if (shots.contains(frame.shot_id)) continue;
    throw Corrupt(recording.frame_path(frame).string() + ": belongs to shot " + std::to_string(frame.shot_id) +
                  ", which the session does not have");
  }
  return runs_of(recording, shots, discards_of(recording));
}

std::vector<RecordedRun> runs_left(const SessionStore& recording, const SessionStore& replay) {
  DiscardsByShot discards = discards_of(recording);
  for (const auto& [id, played] : discards_of(replay)) {
    std::vector<DiscardRecord>& left = discards[id];
    left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(std::min(left.size(), played.size())));
  }
  return runs_of(recording, by_id(replay.missing_shots()), discards);
}

RecordedRun recorded_frames(const SessionStore& recording) {
  RecordedRun frames;
  for (const RecordedRun& run : recorded_runs(recording)) {
    std::copy_if(run.begin(), run.end(), std::back_inserter(frames),
                 [](const RecordedShoot& shoot) { return shoot.frame.has_value(); });
  }
  return frames;
}

Frame load_recorded_frame(const SessionStore& recording, const FrameRecord& record) {
  const std::filesystem::path path = recording.frame_path(record);
  std::string bytes;
  try {
    bytes = read_whole_file(path);
  } catch (const BadInput& error) {
    throw Corrupt(error.what());
  }
  if (sha256_hex(bytes) != record.sha256) {
    throw Corrupt(path.string() + ": its bytes do not match the hash in the journal");
  }
  Frame frame = decode_frame_file(bytes, path.string());
  frame.reported = record.reported;
  frame.device_time_s = record.device_time_s;
  frame.sensor_temperature_c = record.sensor_temperature_c;
  return frame;
}

}  // namespace lumitexel
