#include "processing/report/viewer/viewer_model.h"

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/report/viewer/viewer_layers.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr double kOctahedralSteps = 65534.0;

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<float> flattened(const std::vector<Eigen::Vector3d>& vectors, const Eigen::Vector3d& origin) {
  std::vector<float> values;
  values.reserve(vectors.size() * 3);
  for (const Eigen::Vector3d& vector : vectors) {
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(vector[k] - origin[k]));
  }
  return values;
}

void add_mesh(const Mesh& mesh, PackedChunks& chunks) {
  chunks.add("positions", flattened(mesh.positions, box_of(mesh).centre()));
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

MeshBox box_of(const Mesh& mesh) {
  MeshBox box{mesh.positions.front(), mesh.positions.front()};
  for (const Eigen::Vector3d& position : mesh.positions) {
    box.low = box.low.cwiseMin(position);
    box.high = box.high.cwiseMax(position);
  }
  return box;
}

std::vector<std::uint32_t> textured_texels(const Model& model) {
  std::vector<std::uint32_t> texels;
  for (std::size_t i = 0; i < model.material.size(); ++i) {
    if (model.material[i] != Model::kNoMaterial) texels.push_back(static_cast<std::uint32_t>(i));
  }
  return texels;
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

json viewer_model_json(const Model& model) {
  const MeshBox box = box_of(model.mesh);
  return {{"channels", model.channels},
          {"atlas", {{"width", model.width}, {"height", model.height}}},
          {"centre", vector_json(box.centre())},
          {"box", {{"low", vector_json(box.low - box.centre())}, {"size", vector_json(box.high - box.low)}}},
          {"diagonal_m", (box.high - box.low).norm()},
          {"single", brdf_json(model.single)},
          {"indirect_bounces", model.indirect_bounces},
          {"layers", layers_json(model)},
          {"stages", stages_json(model)}};
}

void add_model_chunks(const Model& model, PackedChunks& chunks) {
  const std::vector<std::uint32_t> texels = textured_texels(model);
  add_mesh(model.mesh, chunks);
  std::vector<std::uint8_t> textured(model.material.size(), 0);
  for (const std::uint32_t texel : texels) textured[texel] = 1;
  chunks.add("textured", textured);
  add_layer_chunks(model, texels, chunks);
  add_normals(model, texels, chunks);
  chunks.add("sigma", halves_of(model.uncertainty, texels));
  chunks.add("samples", halves_of(model.samples, texels));
  if (model.indirect.channels == 2) {
    std::vector<std::uint16_t> found;
    for (const std::uint32_t texel : texels) found.push_back(half_bits(model.indirect.data[std::size_t{2} * texel + 1]));
    chunks.add("indirect", found);
  }
  if (has_normals(model)) chunks.add("normal_sigma", halves_of(model.normal_sigma, texels));
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
