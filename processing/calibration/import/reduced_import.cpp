#include "processing/calibration/import/reduced_import.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "drivers/clock.h"
#include "drivers/error.h"
#include "processing/calibration/import/import_layout.h"
#include "processing/calibration/import/text_fields.h"
#include "rig/pending_directory.h"
#include "rig/sha256.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string, std::less<>>;

NamedText document(const SessionStore& session, const std::string& name) {
  return {session.document(name), session.directory().string() + ": " + name};
}

bool holds_data(std::string_view line) { return !trimmed(line).empty() && line.front() != '#'; }

// The text without the lines for which `drop` says so.
template <typename Drop>
std::string without_lines(const NamedText& source, const Drop& drop) {
  std::string text;
  for (const TextLine& line : lines_of(source.text, source.where)) {
    if (!drop(line)) text += std::string(line.text) + "\n";
  }
  return text;
}

// An image takes two lines; its name is everything after the ninth field.
std::string reduced_images_txt(const NamedText& source, const Names& left_out) {
  bool points_follow = false, dropped = false;
  return without_lines(source, [&](const TextLine& line) {
    if (points_follow) {
      points_follow = false;
      return dropped;
    }
    if (!holds_data(line.text)) return false;
    const std::string_view camera_id = split_at_spaces(line.text).at(8);
    const auto name_at = static_cast<std::size_t>(camera_id.data() + camera_id.size() - line.text.data());
    points_follow = true;
    return dropped = left_out.contains(trimmed(line.text.substr(name_at)));
  });
}

std::string reduced_lights_csv(const NamedText& source, const Names& left_out) {
  std::size_t image_column = 0;
  bool header = true;
  return without_lines(source, [&](const TextLine& line) {
    if (!holds_data(line.text)) return false;
    const std::vector<std::string_view> fields = split_at(line.text, ',');
    if (header) {
      header = false;
      image_column = static_cast<std::size_t>(std::find(fields.begin(), fields.end(), "image") - fields.begin());
      return false;
    }
    return left_out.contains(fields.at(image_column));
  });
}

// Reads import.json, drops views from it and says which frames were theirs.
std::string reduced_import_json(const NamedText& source, const Names& left_out, Names& dropped_frames) {
  try {
    nlohmann::ordered_json root = nlohmann::ordered_json::parse(source.text);
    nlohmann::ordered_json kept = nlohmann::ordered_json::array();
    for (nlohmann::ordered_json& view : root.at("views")) {
      if (!left_out.contains(view.at("image").get<std::string>())) {
        kept.push_back(std::move(view));
        continue;
      }
      dropped_frames.insert(view.at("photograph").get<std::string>());
      if (!view.at("mask").is_null()) dropped_frames.insert(view.at("mask").get<std::string>());
    }
    root["views"] = std::move(kept);
    return root.dump(1) + "\n";
  } catch (const nlohmann::json::exception& error) {
    throw Corrupt(source.where + ": " + error.what());
  }
}

void copy_documents(const SessionStore& session, const Names& left_out, SessionStore& copy, Names& dropped_frames) {
  for (const std::string& name : session.document_names()) {
    const NamedText source = document(session, name);
    if (left_out.empty()) {
      copy.put_document(name, source.text);
    } else if (name == "images.txt") {
      copy.put_document(name, reduced_images_txt(source, left_out));
    } else if (name == "lights.csv") {
      copy.put_document(name, reduced_lights_csv(source, left_out));
    } else if (name == "import.json") {
      copy.put_document(name, reduced_import_json(source, left_out, dropped_frames));
    } else {
      copy.put_document(name, source.text);
    }
  }
}

void copy_frame(const SessionStore& session, const FrameRecord& frame, SessionStore& copy) {
  const fs::path path = session.frame_path(frame);
  std::string bytes;
  try {
    bytes = read_whole_file(path);
  } catch (const BadInput& error) {
    throw Corrupt(error.what());
  }
  if (sha256_hex(bytes) != frame.sha256) {
    throw Corrupt(path.string() + ": its bytes do not match the hash in the journal");
  }
  copy.commit_frame(frame, bytes);
}

std::int64_t fill(const SessionStore& session, const Names& left_out, SessionStore& copy, Progress& progress,
                  const std::stop_token& stop) {
  Names dropped_frames;
  copy_documents(session, left_out, copy, dropped_frames);
  std::vector<FrameRecord> frames = session.frames();
  std::erase_if(frames, [&](const FrameRecord& frame) { return dropped_frames.contains(frame.name); });
  progress.begin("copying", static_cast<std::int64_t>(frames.size()), "files");
  std::int64_t done = 0;
  for (const FrameRecord& frame : frames) {
    if (stop.stop_requested()) throw Cancelled("the replay was stopped; nothing was written");
    copy_frame(session, frame, copy);
    progress.update(++done);
  }
  copy.log_event("info", "copy of " + session.directory().string() + ", content " + session.content_sha256() + ", " +
                             std::to_string(left_out.size()) + " views left out", SystemClock().utc_ns());
  return done;
}

// What a later command would refuse is refused now.
void require_usable(const SessionStore& copy) {
  join_views(document(copy, "cameras.txt"), document(copy, "images.txt"), document(copy, "lights.csv"));
}

}  // namespace

std::vector<SelectableView> imported_views(const SessionStore& session) {
  std::vector<SelectableView> views;
  for (const View& view : join_views(document(session, "cameras.txt"), document(session, "images.txt"),
                                     document(session, "lights.csv"))) {
    views.push_back({view.name, view.heldout});
  }
  return views;
}

std::int64_t copy_import(const SessionStore& session, const ViewSelection& selection, const fs::path& directory,
                         Progress& progress, std::stop_token stop) {
  SessionStore::require_new_directory(directory);
  if (!selection.kinds_left_out.empty()) {
    throw BadInput("--without", std::string("kind=") + to_string(*selection.kinds_left_out.begin()),
                   "views: the photographs of an imported session are of no kind");
  }
  const Names left_out(selection.left_out.begin(), selection.left_out.end());
  PendingDirectory pending(directory);
  std::int64_t frames = 0;
  {
    SessionStore copy = SessionStore::create(pending.path(), SessionKind::Imported);
    frames = fill(session, left_out, copy, progress, stop);
    require_usable(copy);
  }
  const fs::path truth = session.directory() / "truth";
  if (fs::is_directory(truth)) fs::copy(truth, pending.path() / "truth", fs::copy_options::recursive);
  pending.move_into_place();
  return frames;
}

}  // namespace lumitexel
