#include "processing/calibration/captured_frames.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "drivers/error.h"
#include "rig/frame_file.h"
#include "rig/sha256.h"

namespace lumitexel {

CapturedFrames::CapturedFrames(const SessionStore& session) : session_(session) {
  std::map<std::int64_t, FrameRecord> by_shot;
  for (FrameRecord& record : session.frames()) by_shot[record.shot_id] = std::move(record);
  std::size_t missing = 0;
  for (Shot& shot : session.shots()) {
    const auto found = by_shot.find(shot.id);
    if (found == by_shot.end()) {
      ++missing;
    } else {
      taken_.push_back({std::move(shot), std::move(found->second)});
    }
  }
  if (missing > 0 || taken_.empty()) {
    throw BadInput(session.directory().string(), std::to_string(missing) + " shots are missing",
                   "a finished session (lumitexel resume finishes it)");
  }
  std::stable_sort(taken_.begin(), taken_.end(),
                   [](const Taken& a, const Taken& b) { return a.shot.index < b.shot.index; });
}

std::vector<FrameRecord> CapturedFrames::of(ShotKind kind, const std::string& view) const {
  std::vector<FrameRecord> records;
  for (const Taken& taken : taken_) {
    if (taken.shot.kind == kind && taken.shot.view == view) records.push_back(taken.record);
  }
  if (records.empty()) {
    throw BadInput(session_.directory().string(),
                   std::string("no ") + to_string(kind) + " frame" + (view.empty() ? "" : " of view " + view),
                   "the shots of a capture plan");
  }
  return records;
}

std::int64_t CapturedFrames::begun_utc_ns() const {
  const auto earlier = [](const Taken& a, const Taken& b) { return a.record.utc_ns < b.record.utc_ns; };
  return std::min_element(taken_.begin(), taken_.end(), earlier)->record.utc_ns;
}

bool CapturedFrames::has(ShotKind kind) const {
  return std::any_of(taken_.begin(), taken_.end(), [&](const Taken& taken) { return taken.shot.kind == kind; });
}

std::vector<int> CapturedFrames::indices_of(ShotKind kind) const {
  std::vector<int> indices;
  for (const Taken& taken : taken_) {
    if (taken.shot.kind == kind && taken.shot.view.empty()) indices.push_back(taken.shot.index);
  }
  return indices;
}

Frame CapturedFrames::load(const FrameRecord& record) const {
  const std::string path = session_.frame_path(record).string();
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || sha256_hex(bytes) != record.sha256)
    throw Corrupt(path + ": missing, or not the bytes that were committed");
  Frame frame = decode_frame_file(bytes, path);
  // What was asked of the camera, which reported the same in its own units: equal bit for bit over all its frames.
  frame.reported = record.applied;
  frame.sensor_temperature_c = record.sensor_temperature_c;
  return frame;
}

std::vector<Frame> CapturedFrames::load(const std::vector<FrameRecord>& records) const {
  std::vector<Frame> frames;
  for (const FrameRecord& record : records) frames.push_back(load(record));
  return frames;
}

DarkLibrary CapturedFrames::master_darks(const LinearSensor& sensor) const {
  std::map<std::pair<double, double>, std::vector<FrameRecord>> by_settings;
  for (const FrameRecord& record : of(ShotKind::Dark)) {
    by_settings[{record.applied.exposure_s, record.applied.gain_db}].push_back(record);
  }
  DarkLibrary library;
  for (const auto& [settings, records] : by_settings) {
    for (const std::vector<Frame>& group : grouped_by_temperature(load(records))) {
      library.add(make_master_dark(group, sensor));
    }
  }
  return library;
}

}  // namespace lumitexel
