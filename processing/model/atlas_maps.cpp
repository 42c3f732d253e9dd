#include "processing/model/atlas_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/error.h"
#include "processing/image/exr_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr int kPlanesPerFile = 4;
constexpr float kNoMaterialOnDisk = 65535.0f;
constexpr double kUnitTolerance = 1e-3;  // a unit normal in single, or even half, precision passes
const std::vector<std::string> kWeightPlanes{"R", "G", "B", "A"};  // names that every reader shows

constexpr const char* kWeights = "weights_";
constexpr const char* kProjectionWeights = "projection_weights_";

constexpr const char* kIndirectFiles[] = {"indirect_bound.exr", "indirect_share.exr"};
constexpr const char* kBeforeNormals = "before_normals_";

std::string weights_file(const std::string& prefix, int file) { return prefix + std::to_string(file) + ".exr"; }
int weight_files(int basis_size) { return (basis_size + kPlanesPerFile - 1) / kPlanesPerFile; }

std::size_t texels(const Model& model) {
  return static_cast<std::size_t>(model.width) * static_cast<std::size_t>(model.height);
}

void write_cluster_map(const fs::path& path, const Model& model, const std::vector<std::int16_t>& map) {
  ExrPlane plane{"Y", ExrPixel::Uint, std::vector<float>(texels(model))};
  std::transform(map.begin(), map.end(), plane.data.begin(), [](std::int16_t material) {
    return material == Model::kNoMaterial ? kNoMaterialOnDisk : static_cast<float>(material);
  });
  write_exr(path, {model.width, model.height, {std::move(plane)}});
}

// Files are always four planes wide; planes past the last weight are zero.
void write_weights(const fs::path& directory, const std::string& prefix, const Image& weights) {
  const std::size_t count = static_cast<std::size_t>(weights.width) * static_cast<std::size_t>(weights.height);
  for (int file = 0; file < weight_files(weights.channels); ++file) {
    ExrImage exr{weights.width, weights.height, {}};
    for (int plane = 0; plane < kPlanesPerFile; ++plane) {
      std::vector<float> data(count, 0.0f);
      const int k = file * kPlanesPerFile + plane;
      for (std::size_t t = 0; k < weights.channels && t < count; ++t) {
        data[t] = weights.data[t * static_cast<std::size_t>(weights.channels) + static_cast<std::size_t>(k)];
      }
      exr.planes.push_back({kWeightPlanes[static_cast<std::size_t>(plane)], ExrPixel::Float, std::move(data)});
    }
    write_exr(directory / weights_file(prefix, file), exr);
  }
}

std::string texel_name(const fs::path& path, const Model& model, std::size_t texel) {
  const auto width = static_cast<std::size_t>(model.width);
  return path.string() + ": texel (" + std::to_string(texel % width) + ", " + std::to_string(texel / width) + ")";
}

void require_size(const fs::path& path, const Model& model, int width, int height) {
  if (width == model.width && height == model.height) return;
  throw BadInput(path.string(), std::to_string(width) + "x" + std::to_string(height) + " texels",
                 std::to_string(model.width) + "x" + std::to_string(model.height) + " as model.json says");
}

// All values finite and at least `minimum`; the planes by the given names, interleaved.
Image read_map(const fs::path& path, const Model& model, const std::vector<std::string>& names, float minimum) {
  const ExrImage exr = read_exr(path);
  require_size(path, model, exr.width, exr.height);
  Image map(model.width, model.height, static_cast<int>(names.size()));
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto plane =
        std::find_if(exr.planes.begin(), exr.planes.end(), [&](const ExrPlane& p) { return p.name == names[c]; });
    if (plane == exr.planes.end()) throw BadInput(path.string(), "no channel " + names[c], "that channel");
    for (std::size_t t = 0; t < plane->data.size(); ++t) {
      const float value = plane->data[t];
      if (!std::isfinite(value) || value < minimum) {
        throw BadInput(texel_name(path, model, t) + ", channel " + names[c], std::to_string(value),
                       minimum == 0.0f ? "a finite value of 0 or more" : "a finite value");
      }
      map.data[t * names.size() + c] = value;
    }
  }
  return map;
}

std::vector<std::int16_t> read_cluster_map(const fs::path& path, const Model& model, std::size_t materials) {
  const Image map = read_map(path, model, {"Y"}, 0.0f);
  std::vector<std::int16_t> result(map.data.size());
  for (std::size_t t = 0; t < map.data.size(); ++t) {
    const float value = map.data[t];
    const bool none = value == kNoMaterialOnDisk;
    if (!none && (value != std::floor(value) || value >= static_cast<float>(materials))) {
      throw BadInput(texel_name(path, model, t), "material " + std::to_string(value),
                     "65535 or a material below " + std::to_string(materials));
    }
    result[t] = static_cast<std::int16_t>(none ? Model::kNoMaterial : static_cast<int>(value));
  }
  return result;
}

Image read_weights(const fs::path& directory, const std::string& prefix, int basis_size, const Model& model) {
  Image weights(model.width, model.height, basis_size);
  for (int file = 0; file < weight_files(basis_size); ++file) {
    const Image four = read_map(directory / weights_file(prefix, file), model, kWeightPlanes, 0.0f);
    const int planes = std::min(kPlanesPerFile, basis_size - file * kPlanesPerFile);
    for (std::size_t t = 0; t < texels(model); ++t) {
      const float* from = &four.data[t * kPlanesPerFile];
      std::copy(from, from + planes,
                &weights.data[t * static_cast<std::size_t>(basis_size) + static_cast<std::size_t>(file * kPlanesPerFile)]);
    }
  }
  return weights;
}

void read_normals(const fs::path& path, Model& model) {
  model.normal = read_map(path, model, {"R", "G", "B"}, std::numeric_limits<float>::lowest());
  for (std::size_t t = 0; t < texels(model); ++t) {
    const float* n = &model.normal.data[3 * t];
    const double length = std::sqrt(static_cast<double>(n[0]) * n[0] + static_cast<double>(n[1]) * n[1] +
                                    static_cast<double>(n[2]) * n[2]);
    if (length != 0.0 && std::abs(length - 1.0) > kUnitTolerance) {
      throw BadInput(texel_name(path, model, t), "a normal of length " + std::to_string(length),
                     "length 1, or 0 for none");
    }
  }
}

void add_layer(const std::string& prefix, const LayerShape& layer, std::vector<AtlasMap>& maps) {
  maps.push_back({prefix + "cluster.exr", {"Y"}});
  for (const char* weights : {kWeights, kProjectionWeights}) {
    if (weights == kProjectionWeights && !layer.principal_functions) continue;
    for (int file = 0; file < weight_files(layer.basis_size); ++file) {
      maps.push_back({weights_file(prefix + weights, file), kWeightPlanes});
    }
  }
}

void write_layer(const fs::path& directory, const std::string& prefix, const Model& model, const std::vector<std::int16_t>& material,
                 const Image& weights, const Image& projection_weights) {
  write_cluster_map(directory / (prefix + "cluster.exr"), model, material);
  write_weights(directory, prefix + kWeights, weights);
  if (projection_weights.channels > 0) write_weights(directory, prefix + kProjectionWeights, projection_weights);
}

void read_layer(const fs::path& directory, const std::string& prefix, const LayerShape& shape, const Model& model, ReflectanceLayer& layer) {
  layer.material = read_cluster_map(directory / (prefix + "cluster.exr"), model, layer.materials.size());
  layer.weights = read_weights(directory, prefix + kWeights, shape.basis_size, model);
  if (shape.principal_functions) {
    layer.projection_weights = read_weights(directory, prefix + kProjectionWeights, shape.basis_size, model);
  }
}

void write_indirect(const fs::path& directory, const Image& indirect) {
  for (int k = 0; k < indirect.channels; ++k) {
    Image plane(indirect.width, indirect.height, 1);
    for (std::size_t t = 0; t < plane.data.size(); ++t) plane.data[t] = indirect.data[2 * t + static_cast<std::size_t>(k)];
    write_exr_colour(directory / kIndirectFiles[k], plane);
  }
}

void read_indirect(const fs::path& directory, Model& model) {
  model.indirect = Image(model.width, model.height, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const Image plane = read_map(directory / kIndirectFiles[k], model, {"Y"}, 0.0f);
    for (std::size_t t = 0; t < plane.data.size(); ++t) model.indirect.data[2 * t + k] = plane.data[t];
  }
}

}  // namespace

std::vector<AtlasMap> atlas_maps(const MapsShape& shape) {
  std::vector<AtlasMap> maps{{"normal.exr", {"R", "G", "B"}}, {"uncertainty.exr", {"Y"}}, {"samples.exr", {"Y"}}};
  add_layer("", shape.layer, maps);
  if (shape.before_normals) {
    add_layer(kBeforeNormals, *shape.before_normals, maps);
    maps.push_back({"normal_sigma.exr", {"Y"}});
  }
  if (shape.indirect) {
    for (const char* file : kIndirectFiles) maps.push_back({file, {"Y"}});
  }
  return maps;
}

void write_atlas_maps(const fs::path& directory, const Model& model) {
  write_layer(directory, "", model, model.material, model.weights, model.projection_weights);
  write_exr_colour(directory / "normal.exr", model.normal);
  write_exr_colour(directory / "uncertainty.exr", model.uncertainty);
  write_exr_colour(directory / "samples.exr", model.samples);
  write_indirect(directory, model.indirect);
  if (!has_normals(model)) return;
  const ReflectanceLayer& before = *model.before_normals;
  write_layer(directory, kBeforeNormals, model, before.material, before.weights, before.projection_weights);
  write_exr_colour(directory / "normal_sigma.exr", model.normal_sigma);
}

void read_atlas_maps(const fs::path& directory, const MapsShape& shape, Model& model) {
  ReflectanceLayer last{std::move(model.materials), {}, {}, {}};
  read_layer(directory, "", shape.layer, model, last);
  model.materials = std::move(last.materials);
  model.material = std::move(last.material);
  model.weights = std::move(last.weights);
  model.projection_weights = std::move(last.projection_weights);
  read_normals(directory / "normal.exr", model);
  model.uncertainty = read_map(directory / "uncertainty.exr", model, {"Y"}, 0.0f);
  model.samples = read_map(directory / "samples.exr", model, {"Y"}, 0.0f);
  if (shape.indirect) read_indirect(directory, model);
  if (!shape.before_normals) return;
  read_layer(directory, kBeforeNormals, *shape.before_normals, model, *model.before_normals);
  model.normal_sigma = read_map(directory / "normal_sigma.exr", model, {"Y"}, 0.0f);
}

}  // namespace lumitexel
