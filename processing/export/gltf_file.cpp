#include "processing/export/gltf_file.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "processing/export/loss_json.h"
#include "processing/export/tangent_frame.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "glTF's buffers are little endian");
constexpr int kFloat = 5126, kUnsigned = 5125, kVertexTarget = 34962, kIndexTarget = 34963;
constexpr double kDielectricF0 = 0.04;  // what specularColor multiplies

class BufferWriter {
 public:
  template <typename T>
  int add(const std::vector<T>& values, int components, const char* type, int component_type, int target) {
    const std::size_t start = bytes_.size(), size = values.size() * sizeof(T);
    bytes_.resize(start + size);
    std::memcpy(bytes_.data() + start, values.data(), size);
    const auto view = views.size();
    views.push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", size}, {"target", target}});
    accessors.push_back({{"bufferView", view}, {"componentType", component_type}, {"type", type},
                         {"count", values.size() / static_cast<std::size_t>(components)}});
    return static_cast<int>(view);
  }
  const std::string& bytes() const { return bytes_; }
  json views = json::array(), accessors = json::array();

 private:
  std::string bytes_;
};

void bound(json& accessor, const std::vector<float>& xyz) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], xyz[i]);
    high[i % 3] = std::max(high[i % 3], xyz[i]);
  }
  accessor["min"] = low;
  accessor["max"] = high;
}

json primitive_of(const Mesh& mesh, bool with_tangents, BufferWriter& buffer) {
  std::vector<float> positions, normals, texcoords;
  std::vector<std::uint32_t> indices;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3d normal = mesh.normals[v].normalized();
    for (int k = 0; k < 3; ++k) {
      positions.push_back(static_cast<float>(mesh.positions[v][k]));
      normals.push_back(static_cast<float>(normal[k]));
    }
    texcoords.push_back(static_cast<float>(mesh.texcoords[v].x()));
    texcoords.push_back(static_cast<float>(1.0 - mesh.texcoords[v].y()));  // glTF's v runs down
  }
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  const int position = buffer.add(positions, 3, "VEC3", kFloat, kVertexTarget);
  bound(buffer.accessors[static_cast<std::size_t>(position)], positions);
  const int normal = buffer.add(normals, 3, "VEC3", kFloat, kVertexTarget);
  const int texcoord = buffer.add(texcoords, 2, "VEC2", kFloat, kVertexTarget);
  const int index = buffer.add(indices, 1, "SCALAR", kUnsigned, kIndexTarget);
  json attributes = {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", texcoord}};
  if (with_tangents) {
    std::vector<float> tangents;
    for (const Eigen::Vector4d& tangent : vertex_tangents(mesh)) {
      for (int k = 0; k < 4; ++k) tangents.push_back(static_cast<float>(tangent[k]));
    }
    attributes["TANGENT"] = buffer.add(tangents, 4, "VEC4", kFloat, kVertexTarget);
  }
  return {{"attributes", attributes}, {"indices", index}, {"material", 0}};
}

json material_of(const ExportedMaps& maps) {
  const double factor = maps.most_share / kDielectricF0;
  const json texture = {{"index", 1}};  // the colour in its RGB, the factor in its alpha
  json material = {
      {"pbrMetallicRoughness",
       {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 2}}}, {"metallicFactor", 0.0}}},
      {"extensions",
       {{"KHR_materials_specular",
         {{"specularColorFactor", {factor, factor, factor}}, {"specularColorTexture", texture}, {"specularTexture", texture}}}}}};
  if (maps.normal.channels > 0) material["normalTexture"] = {{"index", 3}};
  return material;
}

// Colour, and the factor in alpha, where the extension looks for it.
Image specular_with_factor(const ExportedMaps& maps) {
  Image packed(maps.specular.width, maps.specular.height, 4);
  for (std::size_t t = 0; t < maps.specular_factor.data.size(); ++t) {
    std::copy_n(&maps.specular.data[3 * t], 3, &packed.data[4 * t]);
    packed.data[4 * t + 3] = maps.specular_factor.data[t];
  }
  return packed;
}

// Green is roughness, blue metalness: none.
Image metallic_roughness(const Image& roughness) {
  Image packed(roughness.width, roughness.height, 3);
  for (std::size_t t = 0; t < roughness.data.size(); ++t) packed.data[3 * t + 1] = roughness.data[t];
  return packed;
}

}  // namespace

void write_gltf(const std::filesystem::path& directory, const Mesh& mesh, const ExportedMaps& maps, const ConversionLoss& loss) {
  write_png8(directory / "base.png", maps.base);
  write_png8(directory / "specular.png", specular_with_factor(maps));
  write_png8(directory / "metallic_roughness.png", metallic_roughness(maps.roughness));
  BufferWriter buffer;
  const bool with_normals = maps.normal.channels > 0;
  const json primitive = primitive_of(mesh, with_normals, buffer);
  json document;
  document["asset"] = {{"version", "2.0"}, {"generator", "Lumitexel"},
                       {"extras", {{"conversion_loss", loss_json(loss)}, {"unit", "metre"}, {"axes", "the session's world, whose z is up, turned by the node to glTF's, whose y is"}}}};
  document["extensionsUsed"] = {"KHR_materials_specular"};
  document["scene"] = 0;
  document["scenes"] = json::array({{{"nodes", {0}}}});
  const double half = std::sqrt(0.5);  // a quarter turn about x: z becomes y
  document["nodes"] = json::array({{{"mesh", 0}, {"rotation", {-half, 0.0, 0.0, half}}}});
  document["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
  document["materials"] = json::array({material_of(maps)});
  // Clamped: opposite edges of an atlas have nothing to do with each other.
  document["samplers"] = json::array({{{"magFilter", 9729}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33071}}});
  document["images"] = json::array({{{"uri", "base.png"}}, {{"uri", "specular.png"}}, {{"uri", "metallic_roughness.png"}}});
  if (with_normals) {
    write_png8(directory / "normal.png", maps.normal);
    document["images"].push_back({{"uri", "normal.png"}});
  }
  for (std::size_t i = 0; i < document["images"].size(); ++i) document["textures"].push_back({{"source", i}, {"sampler", 0}});
  document["bufferViews"] = buffer.views;
  document["accessors"] = buffer.accessors;
  document["buffers"] = json::array({{{"uri", "model.bin"}, {"byteLength", buffer.bytes().size()}}});
  write_whole_file(directory / "model.bin", buffer.bytes());
  write_whole_file(directory / "model.gltf", document.dump(1) + "\n");
}

}  // namespace lumitexel
