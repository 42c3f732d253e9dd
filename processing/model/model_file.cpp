#include "processing/model/model_file.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/model/atlas_maps.h"
#include "processing/model/basis_file.h"
#include "processing/model/model_hashes.h"
#include "processing/surface/mesh_file.h"
#include "rig/replace_directory.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lumitexel model";
constexpr int kVersion = 1;
constexpr int kMostBounces = 1000;
constexpr int kLargestAtlas = 1 << 15;  // a side of more than this is a damaged number, not an atlas
// ---- writing

LayerShape shape_of(const Image& weights, const Image& projection_weights) { return {weights.channels, projection_weights.channels > 0}; }

std::optional<LayerShape> shape_before_normals(const Model& model) {
  if (!has_normals(model)) return {};
  return shape_of(model.before_normals->weights, model.before_normals->projection_weights);
}

Json to_json(const LayerShape& shape, std::size_t materials) {
  return {{"materials", materials}, {"basis_size", shape.basis_size}, {"principal_functions", shape.principal_functions}};
}

bool looked_for_indirect(const Model& model) { return !model.indirect.data.empty(); }

Json model_json(const Model& model, const std::map<std::string, std::string>& hashes) {
  const Json provenance = Json::parse(model.provenance_json, nullptr, false);
  if (!provenance.is_object()) throw Error("model: its provenance is not a JSON object");
  Json maps = Json::object();
  const LayerShape shape = shape_of(model.weights, model.projection_weights);
  const std::optional<LayerShape> before = shape_before_normals(model);
  for (const AtlasMap& map : atlas_maps({shape, before, looked_for_indirect(model)})) maps[map.file] = map.channels;
  Json document = {{"format", kFormat},
                   {"version", kVersion},
                   {"channels", colour_channel_names(model.channels)},
                   {"atlas", {{"width", model.width}, {"height", model.height}}}};
  document.update(to_json(shape, model.materials.size()));
  if (before) document["before_normals"] = to_json(*before, model.before_normals->materials.size());
  if (looked_for_indirect(model)) document["indirect_bounces"] = model.indirect_bounces;
  document["maps"] = maps;
  document["sha256"] = hashes;
  document["provenance"] = provenance;
  return document;
}

bool layer_fits(const Model& model, const std::vector<ModelMaterial>& materials, const std::vector<std::int16_t>& material,
                const Image& weights, const Image& projection_weights) {
  std::size_t basis_size = 0;
  bool bases_fit = true;
  const bool principal = projection_weights.channels > 0;
  for (const ModelMaterial& entry : materials) {
    basis_size = std::max(basis_size, entry.basis.size());
    bases_fit = bases_fit && entry.projection_basis.size() == (principal ? entry.basis.size() : 0);
  }
  const std::size_t texels = static_cast<std::size_t>(model.width) * static_cast<std::size_t>(model.height);
  const auto fits = [&](const Image& map) {
    return map.width == model.width && map.height == model.height && map.channels == static_cast<int>(basis_size) &&
           map.data.size() == texels * basis_size;
  };
  return bases_fit && material.size() == texels && fits(weights) && (!principal || fits(projection_weights));
}

void require_consistent(const Model& model) {
  const auto fits = [&](const Image& map, int channels) {
    return map.width == model.width && map.height == model.height && map.channels == channels &&
           map.data.size() == model.material.size() * static_cast<std::size_t>(channels);
  };
  bool consistent = layer_fits(model, model.materials, model.material, model.weights, model.projection_weights) &&
                    model.mesh.texcoords.size() == model.mesh.positions.size() && fits(model.normal, 3) && fits(model.uncertainty, 1) &&
                    fits(model.samples, 1);
  if (has_normals(model)) {
    const ReflectanceLayer& before = *model.before_normals;
    consistent = consistent && fits(model.normal_sigma, 1) &&
                 layer_fits(model, before.materials, before.material, before.weights, before.projection_weights);
  }
  consistent = consistent && (!looked_for_indirect(model) || fits(model.indirect, 2));
  if (!consistent) throw Error("model: maps, mesh and basis do not fit together");
}

void write_files(const fs::path& directory, const Model& model) {
  write_whole_file(directory / "basis.json", encode_basis(model));
  write_atlas_maps(directory, model);
  write_ply(directory / "mesh.ply", model.mesh);
  if (!model.outliers_csv.empty()) write_whole_file(directory / "outliers.csv", model.outliers_csv);
  write_whole_file(directory / "model.json", model_json(model, file_hashes(directory)).dump(1) + "\n");
}

bool is_model(const fs::path& directory) {
  std::ifstream file(directory / "model.json", std::ios::binary);
  const Json document = Json::parse(file, nullptr, false);
  return document.is_object() && document.contains("format") && document.at("format") == kFormat;
}

fs::path sibling(const fs::path& target, const std::string& suffix) {
  return target.parent_path() / ("." + target.filename().string() + suffix);
}

// ---- reading

// What the evaluation and the report look up; everything else in the provenance is the fit's own affair.
struct ProvenanceType {
  const char* key;
  bool (*is_right)(const Json&);
  const char* expected;
};
constexpr ProvenanceType kProvenanceTypes[] = {
    {"session_key", [](const Json& value) { return value.is_string(); }, "a string"},
    {"rms", [](const Json& value) { return value.is_object(); }, "an object, one number a stage"},
    {"rms_by_channel", [](const Json& value) { return value.is_object(); }, "an object, one list a stage"},
    {"rms_by_material", [](const Json& value) { return value.is_object(); }, "an object, one list a stage"},
    {"stages", [](const Json& value) { return value.is_array(); }, "a list, one entry a stage"},
    {"options", [](const Json& value) { return value.is_object(); }, "an object"},
};

struct LayerHeader {
  int materials = 0;
  LayerShape shape;
};

struct ModelHeader {
  Model model;  // channels, width, height, provenance
  LayerHeader layer;
  std::optional<LayerHeader> before_normals;
  bool indirect = false;
};

int int_field(const Json& parent, const char* key, int minimum, int maximum, const std::string& where) {
  const std::string name = where + ": " + key;
  if (!parent.is_object() || !parent.contains(key)) throw BadInput(name, "missing", "an integer");
  const Json& value = parent.at(key);
  const bool fits =
      value.is_number_integer() && value.get<std::int64_t>() >= minimum && value.get<std::int64_t>() <= maximum;
  if (!fits)
    throw BadInput(name, value.dump(), "an integer from " + std::to_string(minimum) + " to " + std::to_string(maximum));
  return value.get<int>();
}

LayerHeader parse_layer(const Json& document, const std::string& where) {
  LayerHeader layer;
  layer.materials = int_field(document, "materials", 0, std::numeric_limits<std::int16_t>::max(), where);
  layer.shape.basis_size = int_field(document, "basis_size", 0, 1000, where);
  const Json principal = document.value("principal_functions", Json(false));
  if (!principal.is_boolean()) throw BadInput(where + ": principal_functions", principal.dump(), "true or false");
  layer.shape.principal_functions = principal.get<bool>();
  return layer;
}

ModelHeader parse_header(const std::string& text, const std::string& where) {
  const Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) throw BadInput(where, "no JSON: damaged, or cut off", "the description of a model");
  const bool ours = document.is_object() && document.contains("format") && document.at("format") == kFormat;
  if (!ours) throw BadInput(where, "no \"format\": \"" + std::string(kFormat) + "\"", "the description of a model");
  int_field(document, "version", kVersion, kVersion, where);
  ModelHeader header;
  const Json channels = document.value("channels", Json());
  header.model.channels = channels.is_array() ? static_cast<int>(channels.size()) : 0;
  if (header.model.channels != 1 && header.model.channels != kMaxChannels) {
    throw BadInput(where + ": channels", channels.dump(), "the names of one or three channels");
  }
  const Json atlas = document.value("atlas", Json());
  header.model.width = int_field(atlas, "width", 1, kLargestAtlas, where + ": atlas");
  header.model.height = int_field(atlas, "height", 1, kLargestAtlas, where + ": atlas");
  header.layer = parse_layer(document, where);
  if (document.contains("before_normals")) {
    header.before_normals = parse_layer(document.at("before_normals"), where + ": before_normals");
  }
  header.indirect = document.contains("indirect_bounces");
  if (header.indirect) header.model.indirect_bounces = int_field(document, "indirect_bounces", 0, kMostBounces, where);
  const Json provenance = document.value("provenance", Json());
  if (!provenance.is_object()) throw BadInput(where + ": provenance", provenance.dump(), "an object");
  for (const auto& [key, is_right, expected] : kProvenanceTypes) {
    if (provenance.contains(key) && !is_right(provenance.at(key))) {
      throw BadInput(where + ": provenance." + key, provenance.at(key).dump(), expected);
    }
  }
  header.model.provenance_json = provenance.dump();
  return header;
}

void check_basis(const std::vector<ModelMaterial>& materials, const LayerHeader& layer, const std::string& where) {
  std::size_t basis_size = 0;
  for (const ModelMaterial& material : materials) {
    basis_size = std::max(basis_size, material.basis.size());
    const std::size_t before = layer.shape.principal_functions ? material.basis.size() : 0;
    if (material.projection_basis.size() == before) continue;
    throw BadInput(where, std::to_string(material.projection_basis.size()) + " in a projection_basis",
                   std::to_string(before) + " as model.json says");
  }
  if (materials.size() != static_cast<std::size_t>(layer.materials)) {
    throw BadInput(where, std::to_string(materials.size()) + " entries", std::to_string(layer.materials) + " as model.json says");
  }
  if (basis_size != static_cast<std::size_t>(layer.shape.basis_size)) {
    throw BadInput(where, "a largest basis of " + std::to_string(basis_size),
                   std::to_string(layer.shape.basis_size) + " as model.json says");
  }
}

void read_basis(const fs::path& path, const ModelHeader& header, Model& model) {
  BasisTable table = parse_basis(read_whole_file(path), model.channels, path.string());
  check_basis(table.materials, header.layer, path.string() + ".materials");
  if (table.before_normals.has_value() != header.before_normals.has_value()) {
    throw BadInput(path.string() + ".before_normals", table.before_normals ? "there" : "missing", "as model.json says");
  }
  model.single = std::move(table.single);
  model.materials = std::move(table.materials);
  if (!header.before_normals) return;
  check_basis(*table.before_normals, *header.before_normals, path.string() + ".before_normals");
  model.before_normals = ReflectanceLayer{std::move(*table.before_normals), {}, {}, {}};
}

}  // namespace

fs::path without_trailing_slash(const fs::path& directory) {
  const fs::path absolute = fs::absolute(directory).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

void check_model_directory(const fs::path& directory) {
  if (directory.empty()) throw BadInput("--out", "no name", "a new folder or a model to replace");
  const fs::path target = without_trailing_slash(directory);
  if (fs::exists(target) && !is_model(target) && !(fs::is_directory(target) && fs::is_empty(target))) {
    throw BadInput(directory.string(), "exists and is not a model", "a new folder or a model to replace");
  }
  // Before hours of work, not after them.
  std::error_code failure;
  const fs::path probe = sibling(target, ".writing");
  fs::create_directories(probe, failure);
  if (failure) throw BadInput(directory.string(), "cannot be made: " + failure.message(), "a folder that can be written");
  fs::remove_all(probe, failure);
}

void write_model(const fs::path& directory, const Model& model) {
  check_model_directory(directory);
  const fs::path target = without_trailing_slash(directory);
  require_consistent(model);
  const fs::path fresh = sibling(target, ".writing");
  try {
    fs::remove_all(fresh);
    fs::create_directories(fresh);
    write_files(fresh, model);
    replace_directory(fresh, target);
  } catch (const fs::filesystem_error& error) {
    throw Error(directory.string() + ": could not be written: " + error.code().message());
  } catch (const Error&) {
    std::error_code ignored;
    fs::remove_all(fresh, ignored);
    throw;
  }
}

Model read_model(const fs::path& directory) {
  if (!fs::is_directory(directory)) throw BadInput(directory.string(), "no such folder", "the folder of a model");
  const fs::path description = directory / "model.json";
  ModelHeader header = parse_header(read_whole_file(description), description.string());
  Model model = std::move(header.model);
  read_basis(directory / "basis.json", header, model);
  std::optional<LayerShape> before;
  if (header.before_normals) before = header.before_normals->shape;
  read_atlas_maps(directory, {header.layer.shape, before, header.indirect}, model);
  model.mesh = read_mesh(directory / "mesh.ply");
  if (fs::exists(directory / "outliers.csv")) model.outliers_csv = read_whole_file(directory / "outliers.csv");
  if (model.mesh.texcoords.size() != model.mesh.positions.size()) {
    throw BadInput((directory / "mesh.ply").string(), "no texture coordinates", "s and t at every vertex");
  }
  return model;
}

}  // namespace lumitexel
