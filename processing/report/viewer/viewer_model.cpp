#include "processing/report/viewer/viewer_model.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "processing/report/material_pictures.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr double kOctahedralSteps = 65534.0;
constexpr std::uint16_t kNoMaterialCode = 65535;

struct Box {
  Eigen::Vector3d low, high;
};

Box box_of(const Mesh& mesh) {
  Box box{mesh.positions.front(), mesh.positions.front()};
  for (const Eigen::Vector3d& position : mesh.positions) {
    box.low = box.low.cwiseMin(position);
    box.high = box.high.cwiseMax(position);
  }
  return box;
}

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json lobe_json(const Lobe& lobe) {
  const bool off = !std::isfinite(lobe.log_strength);
  return {{"log_strength", off ? json() : json(lobe.log_strength)}, {"log_shape", lobe.log_shape}, {"aim", lobe.aim}};
}

json brdf_json(const Brdf& brdf) {
  const auto channels = static_cast<std::size_t>(brdf.channels);
  json lobes = json::array();
  for (const auto& lobe : brdf.lobes) {
    json by_channel = json::array();
    for (std::size_t c = 0; c < channels; ++c) by_channel.push_back(lobe_json(lobe[c]));
    lobes.push_back(by_channel);
  }
  json diffuse = json::array();
  for (std::size_t c = 0; c < channels; ++c) diffuse.push_back(brdf.diffuse[c]);
  return {{"family", to_string(brdf.family)}, {"diffuse", diffuse}, {"lobes", lobes}};
}

json basis_json(const std::vector<Brdf>& basis) {
  json list = json::array();
  for (const Brdf& brdf : basis) list.push_back(brdf_json(brdf));
  return list;
}

std::vector<float> flattened(const std::vector<Eigen::Vector3d>& vectors, const Eigen::Vector3d& origin) {
  std::vector<float> values;
  values.reserve(vectors.size() * 3);
  for (const Eigen::Vector3d& vector : vectors) {
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(vector[k] - origin[k]));
  }
  return values;
}

void add_mesh(const Mesh& mesh, PackedChunks& chunks) {
  const Box box = box_of(mesh);
  chunks.add("positions", flattened(mesh.positions, 0.5 * (box.low + box.high)));
  chunks.add("normals", flattened(mesh.normals, Eigen::Vector3d::Zero()));
  std::vector<float> texcoords;
  for (const Eigen::Vector2d& texcoord : mesh.texcoords) {
    texcoords.push_back(static_cast<float>(texcoord.x()));
    texcoords.push_back(static_cast<float>(texcoord.y()));
  }
  chunks.add("texcoords", texcoords);
  // Vertex numbers in two halves: a page of 32-bit integers would need a type of its own for this one array.
  std::vector<std::uint16_t> low, high;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      low.push_back(static_cast<std::uint16_t>(vertex & 0xffffu));
      high.push_back(static_cast<std::uint16_t>(vertex >> 16));
    }
  }
  chunks.add("triangles_low", low, ChunkCoding::Differences);
  chunks.add("triangles_high", high, ChunkCoding::Differences);
}

std::vector<std::uint16_t> halves_of(const Image& map, const std::vector<std::uint32_t>& texels) {
  std::vector<std::uint16_t> halves;
  const auto channels = static_cast<std::size_t>(map.channels);
  halves.reserve(texels.size() * channels);
  for (std::size_t k = 0; k < channels; ++k) {
    for (const std::uint32_t texel : texels) halves.push_back(half_bits(map.data[texel * channels + k]));
  }
  return halves;
}

void add_normals(const Model& model, const std::vector<std::uint32_t>& texels, PackedChunks& chunks) {
  std::vector<std::uint16_t> codes(texels.size() * 2);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float* n = &model.normal.data[std::size_t{3} * texels[i]];
    const auto code = octahedral(Eigen::Vector3d(n[0], n[1], n[2]));
    codes[i] = code[0];
    codes[texels.size() + i] = code[1];
  }
  chunks.add("texel_normals", codes, ChunkCoding::Differences);
}

double sign_of(double value) { return value < 0.0 ? -1.0 : 1.0; }

}  // namespace

std::vector<std::uint32_t> textured_texels(const Model& model) {
  std::vector<std::uint32_t> texels;
  for (std::size_t i = 0; i < model.material.size(); ++i) {
    if (model.material[i] != Model::kNoMaterial) texels.push_back(static_cast<std::uint32_t>(i));
  }
  return texels;
}

json viewer_model_json(const Model& model) {
  const Box box = box_of(model.mesh);
  json materials = json::array();
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    const ModelMaterial& material = model.materials[m];
    materials.push_back({{"brdf", brdf_json(material.brdf)},
                         {"basis", basis_json(material.basis)},
                         {"projection_basis", basis_json(material.projection_basis)},
                         {"colour", material_colour(static_cast<int>(m))}});
  }
  return {{"channels", model.channels},
          {"atlas", {{"width", model.width}, {"height", model.height}}},
          {"centre", vector_json(0.5 * (box.low + box.high))},
          {"diagonal_m", (box.high - box.low).norm()},
          {"basis_size", model.weights.channels},
          {"principal_functions", has_principal_functions(model)},
          {"single", brdf_json(model.single)},
          {"materials", materials}};
}

void add_model_chunks(const Model& model, PackedChunks& chunks) {
  const std::vector<std::uint32_t> texels = textured_texels(model);
  add_mesh(model.mesh, chunks);
  std::vector<std::uint16_t> material(model.material.size(), kNoMaterialCode);
  for (const std::uint32_t texel : texels) material[texel] = static_cast<std::uint16_t>(model.material[texel]);
  chunks.add("material", material);
  add_normals(model, texels, chunks);
  chunks.add("weights", halves_of(model.weights, texels));
  if (has_principal_functions(model)) chunks.add("projection_weights", halves_of(model.projection_weights, texels));
  chunks.add("sigma", halves_of(model.uncertainty, texels));
  chunks.add("samples", halves_of(model.samples, texels));
}

std::array<std::uint16_t, 2> octahedral(const Eigen::Vector3d& unit) {
  const double size = unit.lpNorm<1>();
  if (!(size > 0.0)) return {kNoOctahedral, kNoOctahedral};
  double x = unit.x() / size, y = unit.y() / size;
  if (unit.z() < 0.0) {
    const double folded = (1.0 - std::abs(y)) * sign_of(x);
    y = (1.0 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  const auto code = [](double value) { return static_cast<std::uint16_t>(std::lround((0.5 + 0.5 * value) * kOctahedralSteps)); };
  return {code(x), code(y)};
}

Eigen::Vector3d from_octahedral(const std::array<std::uint16_t, 2>& code) {
  if (code[0] == kNoOctahedral) return Eigen::Vector3d::Zero();
  Eigen::Vector3d unit(2.0 * code[0] / kOctahedralSteps - 1.0, 2.0 * code[1] / kOctahedralSteps - 1.0, 0.0);
  unit.z() = 1.0 - std::abs(unit.x()) - std::abs(unit.y());
  const double below = std::max(0.0, -unit.z());
  unit.x() -= sign_of(unit.x()) * below;
  unit.y() -= sign_of(unit.y()) * below;
  return unit.normalized();
}

}  // namespace lumitexel
