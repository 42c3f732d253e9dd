#include "processing/calibration/import/imported_views.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/calibration/calibrated_views_file.h"
#include "processing/calibration/import/import_layout.h"
#include "processing/calibration/import/imported_photograph.h"
#include "processing/calibration/import/imported_poses.h"
#include "processing/surface/mesh_file.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStageVersion = "imported views 2";  // counted up when the same input gives other results

struct ViewFiles {
  std::string photograph, mask;  // frames; the mask may be empty
};

struct ImportRecord {
  int channels = 0;
  std::string mesh, response;
  std::map<std::string, ViewFiles> files;  // by image
};

NamedText document(const SessionStore& session, const std::string& name) {
  return {session.document(name), (session.directory() / "session.db").string() + ": " + name};
}

ImportRecord read_record(const SessionStore& session) {
  const NamedText json = document(session, "import.json");
  try {
    const nlohmann::json root = nlohmann::json::parse(json.text);
    if (root.at("version") != 1) throw Corrupt(json.where + ": version " + root.at("version").dump() + " is not known");
    ImportRecord record{root.at("channels"), root.at("mesh"), root.at("response"), {}};
    for (const nlohmann::json& view : root.at("views")) {
      const nlohmann::json& mask = view.at("mask");
      record.files[view.at("image")] = {view.at("photograph"), mask.is_null() ? "" : mask.get<std::string>()};
    }
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw Corrupt(json.where + ": " + error.what());
  }
}

CodeResponse response_of(const SessionStore& session, const std::string& name) {
  if (name == "linear") return CodeResponse::linear();
  if (name == "srgb") return CodeResponse::srgb();
  const NamedText csv = document(session, name);
  return CodeResponse::from_csv(csv.text, csv.where);
}

// Gives the mask's pixels, if there is a mask.
std::optional<ObjectPixels> make_photograph(const fs::path& source, const fs::path& mask, const CodeResponse& response,
                                            const fs::path& result) {
  // What is there was put there whole, by renaming.
  RadianceImage image = fs::exists(result) ? read_radiance_image(result) : read_photograph(source, response);
  if (!fs::exists(result)) {
    if (!mask.empty()) apply_mask(mask, image);
    write_radiance_image(result, image);
  }
  if (mask.empty()) return std::nullopt;
  ObjectPixels object{image.radiance.width, image.radiance.height, {}};
  for (const auto flags : image.flags) object.inside.push_back(flags & kPixelOutside ? 0 : 1);
  return object;
}

std::map<std::string, fs::path> frames_of(const SessionStore& session) {
  std::map<std::string, fs::path> frames;
  for (const FrameRecord& frame : session.frames()) frames[frame.name] = session.frame_path(frame);
  return frames;
}

// Writes every view's photograph; the masks as they were given.
std::vector<std::optional<ObjectPixels>> make_photographs(const SessionStore& session, const ImportRecord& record,
                                                          const fs::path& directory, CalibratedSession& result, Progress& progress) {
  const std::map<std::string, fs::path> frames = frames_of(session);
  const auto frame = [&](const std::string& name) {
    const auto it = frames.find(name);
    if (it == frames.end())
      throw Corrupt(session.directory().string() + ": no frame " + name + ", which import.json names");
    return it->second;
  };
  const CodeResponse response = response_of(session, record.response);
  std::vector<std::optional<ObjectPixels>> masks(result.views.size());
  progress.begin("photographs", static_cast<std::int64_t>(result.views.size()), "views");
  std::atomic<std::int64_t> done = 0;
  tbb::parallel_for(std::size_t{0}, result.views.size(), [&](std::size_t i) {
    View& view = result.views[i];
    const auto files = record.files.find(view.name);
    if (files == record.files.end())
      throw Corrupt(session.directory().string() + ": import.json has no view " + view.name);
    const fs::path source = frame(files->second.photograph);
    view.photograph = directory / (source.stem().string() + ".exr");
    masks[i] = make_photograph(source, files->second.mask.empty() ? fs::path() : frame(files->second.mask), response,
                               view.photograph);
    reduce_intensity(view.light, result.channels);
    progress.update(++done);
  });
  return masks;
}

CalibrationSummary calibrate_views(const SessionStore& session, const ImportRecord& record, const fs::path& directory,
                                   const CalibrationOptions& options, CalibratedSession& result, Progress& progress) {
  CalibrationSummary summary;
  result.channels = record.channels;
  result.views =
      join_views(document(session, "cameras.txt"), document(session, "images.txt"), document(session, "lights.csv"));
  const auto masks = make_photographs(session, record, directory, result, progress);
  check_given_poses(result, masks, options, summary, progress);
  for (const View& view : result.views) {
    LightSummary& light = summary.lights.emplace_back();
    light.view = view.name;
    light.position_in_world = view.light.vector_in_world;
  }
  return summary;
}

}  // namespace

std::pair<CalibratedSession, CalibrationSummary> calibrate_imported(const SessionStore& session, Progress& progress,
                                                                    const CalibrationOptions& options) {
  const ImportRecord record = read_record(session);
  const NamedText mesh = document(session, record.mesh);
  const std::string key = sha256_hex(session.content_sha256() + kStageVersion + options.key());
  const fs::path directory = session.derived_directory() / "calibrated" / key;
  auto result = read_calibrated_views(directory);
  if (result) {
    result->first.mesh = parse_mesh(mesh.text, fs::path(record.mesh).extension().string(), mesh.where);
    return std::move(*result);
  }
  fs::create_directories(directory);
  CalibratedSession made;
  made.key = key;
  made.mesh = parse_mesh(mesh.text, fs::path(record.mesh).extension().string(), mesh.where);
  CalibrationSummary summary = calibrate_views(session, record, directory, options, made, progress);
  write_calibrated_views(directory, made, summary);
  return {std::move(made), std::move(summary)};
}

}  // namespace lumitexel
