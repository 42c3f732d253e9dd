#include "processing/calibration/import/import_session.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "drivers/error.h"
#include "processing/calibration/import/import_layout.h"
#include "processing/calibration/import/imported_photograph.h"
#include "processing/surface/mesh_file.h"
#include "rig/pending_directory.h"
#include "rig/session_store.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

// Everything that goes into the session, checked.
struct Checked {
  NamedText cameras_txt, images_txt, lights_csv, mesh, response_csv;
  std::string mesh_document, response;
  CodeResponse curve = CodeResponse::linear();
  std::vector<View> views;      // photograph: the source
  std::vector<fs::path> masks;  // one a view, or none at all
  int channels = 0;
};

NamedText read_text(const fs::path& path) { return {read_whole_file(path), path.string()}; }

void read_mesh_source(const fs::path& path, Checked& checked) {
  std::string format = path.extension().string();
  std::transform(format.begin(), format.end(), format.begin(), [](unsigned char c) { return std::tolower(c); });
  checked.mesh = read_text(path);
  checked.mesh_document = "mesh" + format;
  const Mesh mesh = parse_mesh(checked.mesh.text, format, checked.mesh.where);
  for (const View& view : checked.views) {
    if (has_in_sight(view, mesh)) continue;
    throw BadInput(checked.images_txt.where + ": " + view.name,
                   "no vertex of " + checked.mesh.where + " is in its frame", "a pose from which the mesh is in sight");
  }
}

void choose_response(const std::string& response, Checked& checked) {
  const auto exr = [](const View& view) { return is_exr_name(view.photograph); };
  const auto first = std::find_if(checked.views.begin(), checked.views.end(), exr);
  const auto other = std::find_if_not(checked.views.begin(), checked.views.end(), exr);
  if (first != checked.views.end() && other != checked.views.end()) {
    throw BadInput(other->photograph.string(), "code values beside " + first->name + ", which is EXR",
                   "one kind of photograph");
  }
  checked.response = response.empty() || response == "linear" || response == "srgb" ? response : "response.csv";
  if (other == checked.views.end()) {
    if (response.empty()) checked.response = "linear";
    if (checked.response != "linear") throw BadInput("--response", response, "linear or none, because EXR is linear");
  } else if (response.empty()) {
    throw BadInput("--response", "not given", "linear, srgb or a file, because " + other->name + " holds code values");
  } else if (response == "srgb") {
    checked.curve = CodeResponse::srgb();
  } else if (response != "linear") {
    checked.response_csv = read_text(response);
    checked.curve = CodeResponse::from_csv(checked.response_csv.text, checked.response_csv.where);
  }
}

fs::path mask_of(const fs::path& directory, const std::string& image) {
  const fs::path by_stem = directory / fs::path(image).replace_extension(".png"),
                 by_name = directory / (image + ".png");
  std::error_code ignored;
  return fs::exists(by_stem, ignored) || !fs::exists(by_name, ignored) ? by_stem : by_name;
}

void check_photograph(const View& view, const fs::path* mask, Checked& checked) {
  RadianceImage photograph = read_photograph(view.photograph, checked.curve);
  const Image& radiance = photograph.radiance;
  if (radiance.width != view.camera.width_px || radiance.height != view.camera.height_px) {
    throw BadInput(
        view.photograph.string(),
        "an image of " + std::to_string(radiance.width) + "x" + std::to_string(radiance.height),
        "its camera's " + std::to_string(view.camera.width_px) + "x" + std::to_string(view.camera.height_px));
  }
  if (checked.channels == 0) checked.channels = radiance.channels;
  if (radiance.channels != checked.channels) {
    throw BadInput(view.photograph.string(), std::to_string(radiance.channels) + " channels",
                   std::to_string(checked.channels) + ", as " + checked.views.front().name + " has");
  }
  if (mask != nullptr) apply_mask(*mask, photograph);
}

void stop_if_asked(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled("the import was stopped; nothing was written");
}

Checked check_sources(const ImportSources& sources, Progress& progress, const std::stop_token& stop) {
  Checked checked;
  checked.cameras_txt = read_text(sources.colmap / "cameras.txt");
  checked.images_txt = read_text(sources.colmap / "images.txt");
  checked.lights_csv = read_text(sources.lights);
  checked.views = join_views(checked.cameras_txt, checked.images_txt, checked.lights_csv);
  for (View& view : checked.views) {
    view.photograph = sources.images / view.name;
    if (sources.masks) checked.masks.push_back(mask_of(*sources.masks, view.name));
  }
  choose_response(sources.response, checked);
  read_mesh_source(sources.mesh, checked);
  progress.begin("checking", static_cast<std::int64_t>(checked.views.size()), "photographs");
  for (std::size_t i = 0; i < checked.views.size(); ++i) {
    stop_if_asked(stop);
    check_photograph(checked.views[i], checked.masks.empty() ? nullptr : &checked.masks[i], checked);
    progress.update(static_cast<std::int64_t>(i) + 1);
  }
  return checked;
}

// Frames lie in one folder, photographs of COLMAP may not. Results are named by the frame's stem, so that is what must
// be unique.
std::vector<std::string> frame_names(const Checked& checked) {
  std::vector<std::string> names;
  std::set<std::string> stems;
  for (const View& view : checked.views) {
    std::string name = view.name;
    std::replace(name.begin(), name.end(), '/', '_');
    if (!stems.insert(fs::path(name).stem().string()).second) {
      throw BadInput(checked.images_txt.where + ": NAME",
                     view.name + " differs from another name only by folder or extension",
                     "names that stay apart as one file name each");
    }
    names.push_back(name);
  }
  return names;
}

std::string mask_frame_name(const std::string& photograph) {
  return "mask_" + fs::path(photograph).stem().string() + ".png";
}

std::string import_json(const Checked& checked, const std::vector<std::string>& photographs) {
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    nlohmann::ordered_json view{{"image", checked.views[i].name}, {"photograph", photographs[i]}, {"mask", nullptr}};
    if (!checked.masks.empty()) view["mask"] = mask_frame_name(photographs[i]);
    views.push_back(std::move(view));
  }
  const nlohmann::ordered_json document{{"version", 1},
                                        {"channels", checked.channels},
                                        {"mesh", checked.mesh_document},
                                        {"response", checked.response},
                                        {"views", views}};
  return document.dump(1) + "\n";
}

void commit(SessionStore& store, const std::string& name, const std::string& role, const fs::path& source) {
  NewFrame frame;
  frame.name = name;
  frame.role = role;
  store.commit_frame(frame, read_whole_file(source));
}

void write_session(const fs::path& directory, const Checked& checked, const std::vector<std::string>& photographs,
                   Progress& progress, const std::stop_token& stop) {
  SessionStore store = SessionStore::create(directory, SessionKind::Imported);
  store.put_document("cameras.txt", checked.cameras_txt.text);
  store.put_document("images.txt", checked.images_txt.text);
  store.put_document("lights.csv", checked.lights_csv.text);
  store.put_document(checked.mesh_document, checked.mesh.text);
  if (checked.response == "response.csv") store.put_document("response.csv", checked.response_csv.text);
  store.put_document("import.json", import_json(checked, photographs));
  progress.begin("storing", static_cast<std::int64_t>(photographs.size()), "photographs");
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    stop_if_asked(stop);
    commit(store, photographs[i], "photograph", checked.views[i].photograph);
    if (!checked.masks.empty()) commit(store, mask_frame_name(photographs[i]), "mask", checked.masks[i]);
    progress.update(static_cast<std::int64_t>(i) + 1);
  }
}

}  // namespace

ImportSummary import_session(const ImportSources& sources, const fs::path& session, Progress& progress,
                             std::stop_token stop) {
  SessionStore::require_new_directory(session);
  const Checked checked = check_sources(sources, progress, stop);
  const std::vector<std::string> photographs = frame_names(checked);
  PendingDirectory pending(session);
  write_session(pending.path(), checked, photographs, progress, stop);
  pending.move_into_place();
  const auto heldout =
      std::count_if(checked.views.begin(), checked.views.end(), [](const View& view) { return view.heldout; });
  return {static_cast<int>(checked.views.size()), static_cast<int>(heldout), checked.channels};
}

}  // namespace lumitexel
