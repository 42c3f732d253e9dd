#include "rig/replay_session.h"

#include <algorithm>

#include "drivers/clock.h"
#include "drivers/error.h"
#include "rig/capture_plan.h"
#include "rig/new_session.h"
#include "rig/recorded_devices.h"
#include "rig/recording.h"
#include "rig/reduced_plan.h"
#include "rig/sequencer.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlan = "plan.toml";

std::string place_of(const SessionStore& session, const std::string& document) {
  return session.directory().string() + ": " + document;
}

bool keeps(const ViewSelection& selection, const Shot& shot) {
  if (selection.kinds_left_out.contains(shot.kind)) return false;
  const std::vector<std::string>& kept = selection.kept;
  return shot.view.empty() || std::find(kept.begin(), kept.end(), shot.view) != kept.end();
}

SessionContent content_for(const SessionStore& recording, const ViewSelection& selection) {
  SessionContent content;
  for (const std::string& name : recording.document_names()) content.documents[name] = recording.document(name);
  if (!selection.left_out.empty()) {
    content.documents[kPlan] = plan_with_views(content.documents[kPlan], selection.kept, place_of(recording, kPlan));
  }
  for (const Shot& shot : recording.shots()) {
    if (keeps(selection, shot)) content.shots.push_back(shot);
  }
  content.add_files = [truth = recording.directory() / "truth"](const fs::path& directory) {
    if (fs::is_directory(truth)) fs::copy(truth, directory / "truth", fs::copy_options::recursive);
  };
  content.replayed_from = {fs::absolute(recording.directory()).lexically_normal().string(), recording.content_sha256()};
  return content;
}

std::set<ShotKind> kinds_in(const SessionStore& session) {
  std::set<ShotKind> kinds;
  for (const Shot& shot : session.shots()) kinds.insert(shot.kind);
  return kinds;
}

// Whether a run that failed did so as it was recorded: by its last shoot, which gave no frame then either.
bool ended_as_recorded(const RecordedRun& run, const SessionStore& replay) {
  if (run.back().frame) return false;
  const std::vector<Shot> missing = replay.missing_shots();
  return std::none_of(run.begin(), std::prev(run.end()), [&](const RecordedShoot& shoot) {
    return std::any_of(missing.begin(), missing.end(), [&](const Shot& shot) { return shot.id == shoot.shot.id; });
  });
}

// Faults of this machine, whatever the recording says.
bool is_own_fault(const Error& error) {
  return dynamic_cast<const StorageFull*>(&error) != nullptr || dynamic_cast<const Corrupt*>(&error) != nullptr ||
         dynamic_cast<const Cancelled*>(&error) != nullptr;
}

void play(const std::shared_ptr<const SessionStore>& recording, const RecordedRun& run, SessionStore& replay,
          Progress& progress, std::stop_token stop, ReplaySummary& summary) {
  RigDevices devices = make_recorded_devices(recording, run);
  std::vector<Shot> shots;
  for (const RecordedShoot& shoot : run) shots.push_back(shoot.shot);
  const double start_s = devices.clock->now_s();
  try {
    take_shots(replay, devices, shots, progress, std::move(stop));
  } catch (const Error& error) {
    if (is_own_fault(error) || !ended_as_recorded(run, replay)) throw;
  }
  summary.seconds += devices.clock->now_s() - start_s;
}

}  // namespace

std::vector<SelectableView> planned_views(const SessionStore& recording) {
  std::vector<SelectableView> views;
  for (const PlannedView& view : parse_plan(recording.document(kPlan), place_of(recording, kPlan)).views) {
    views.push_back({view.name, view.heldout});
  }
  return views;
}

SessionStore begin_replay(const SessionStore& recording, const ViewSelection& selection, const fs::path& directory) {
  if (recording.kind() != SessionKind::Captured) {
    throw BadInput(recording.directory().string(), "an imported session", "a session made by `lumitexel capture`");
  }
  const SessionContent content = content_for(recording, selection);
  SessionStore replay = begin_session(directory, content);
  const ReplaySource& source = *content.replayed_from;
  std::string text = "replay of " + source.session + ", content " + source.content_sha256;
  const std::vector<std::string> left_out = left_out_of(recording, replay);
  for (std::size_t i = 0; i < left_out.size(); ++i) text += (i == 0 ? ", without " : ", ") + left_out[i];
  replay.log_event("info", text, SystemClock().utc_ns());
  return replay;
}

std::shared_ptr<const SessionStore> recording_of(const SessionStore& replay) {
  const std::optional<ReplaySource> source = replay.replay_source();
  if (!source) return nullptr;
  const std::string place = replay.directory().string() + ": a replay of " + source->session;
  std::shared_ptr<const SessionStore> recording;
  try {
    recording = std::make_shared<const SessionStore>(SessionStore::open(source->session, OpenMode::ReadOnly));
  } catch (const BadInput&) {
    throw BadInput(place, "there is no session there any more", "the recording where it was, to play the rest of it");
  }
  if (recording->content_sha256() != source->content_sha256) {
    throw BadInput(place, "that session has changed since", "the recording as it was; begin a new replay");
  }
  return recording;
}

std::vector<std::string> left_out_of(const SessionStore& recording, const SessionStore& replay) {
  std::set<std::string> kept;
  for (const SelectableView& view : planned_views(replay)) kept.insert(view.name);
  std::vector<std::string> left_out;
  for (const SelectableView& view : planned_views(recording)) {
    if (!kept.contains(view.name)) left_out.push_back(view.name);
  }
  const std::set<ShotKind> kinds = kinds_in(replay);
  for (const ShotKind kind : kinds_in(recording)) {
    if (!kinds.contains(kind)) left_out.push_back(std::string("kind=") + to_string(kind));
  }
  return left_out;
}

ReplaySummary play_missing_shots(const std::shared_ptr<const SessionStore>& recording, SessionStore& replay,
                                 Progress& progress, std::stop_token stop) {
  ReplaySummary summary;
  const std::size_t frames = replay.frames().size(), discards = replay.discards().size();
  for (const RecordedRun& run : runs_left(*recording, replay)) play(recording, run, replay, progress, stop, summary);
  summary.frames = static_cast<std::int64_t>(replay.frames().size() - frames);
  summary.discards = static_cast<std::int64_t>(replay.discards().size() - discards);
  return summary;
}

}  // namespace lumitexel
