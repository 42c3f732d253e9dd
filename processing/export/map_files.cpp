#include "processing/export/map_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "processing/export/loss_json.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "processing/image/tone_map.h"
#include "processing/surface/mesh_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using nlohmann::json;
constexpr float kNoCluster = 65535.0f;

struct MapText {
  const char *name, *what, *unit;
};

class MapWriter {
 public:
  explicit MapWriter(const std::filesystem::path& directory) : directory_(directory) {}

  // Colours of surfaces, 0 to 1.
  void add_colour(const MapText& text, const Image& linear) {
    Image coded = linear;
    for (float& value : coded.data) value = srgb_encoded(value);
    add(text, linear, coded, {"linear Rec. 709", "sRGB (IEC 61966-2-1)", 1.0, 0.0}, ExrPixel::Float);
  }
  // Numbers >= 0, of which the largest becomes white, or 1 if that is what they end at.
  void add_numbers(const MapText& text, const Image& values, double full_scale) {
    Image coded = values;
    for (float& value : coded.data) value = static_cast<float>(value / full_scale);
    add(text, values, coded, {"none: numbers", "none: linear", full_scale, 0.0}, ExrPixel::Float);
  }
  void add_vectors(const MapText& text, const Image& unit_vectors) {
    add(text, unit_vectors, coded_normals(unit_vectors), {"none: vectors", "none: linear", 1.0, -1.0}, ExrPixel::Float);
  }
  void add_clusters(const MapText& text, const Image& clusters) {
    Image coded = clusters;
    for (float& value : coded.data) value = value / 255.0f;  // 65535, and what 8 bits do not hold, clips to 255
    add(text, clusters, coded, {"none: indices", "none: indices", 255.0, 0.0}, ExrPixel::Uint);
  }
  // Whose numbers the next maps hold.
  void come_from(const char* origin) { origin_ = origin; }
  const json& entries() const { return entries_; }

 private:
  struct Coding {
    const char *exr_space, *png_space;
    double full_scale, zero;
  };
  void add(const MapText& text, const Image& values, const Image& coded, const Coding& coding, ExrPixel stored) {
    const std::string exr = std::string(text.name) + ".exr", png = std::string(text.name) + ".png";
    write_exr_colour(directory_ / exr, values, stored);
    write_png8(directory_ / png, coded);
    entries_.push_back({{"name", text.name}, {"of", origin_}, {"exr", exr}, {"png", png}, {"channels", values.channels}, {"what", text.what}, {"unit", text.unit},
                        {"exr_colour_space", coding.exr_space}, {"png_colour_space", coding.png_space},
                        {"png_full_scale", coding.full_scale}, {"png_zero", coding.zero}});
  }
  std::filesystem::path directory_;
  const char* origin_ = "";
  json entries_ = json::array();
};

void add_material(MapWriter& writer, const RefittedAtlas& atlas) {
  Image base(atlas.width, atlas.height, 3), specular = base, roughness(atlas.width, atlas.height, 1), factor = roughness;
  for (std::size_t t = 0; t < atlas.texels.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      base.data[3 * t + c] = static_cast<float>(atlas.texels[t].base[c]);
      specular.data[3 * t + c] = static_cast<float>(atlas.texels[t].f0[c]);
    }
    factor.data[t] = static_cast<float>(atlas.texels[t].specular);
    roughness.data[t] = static_cast<float>(atlas.texels[t].roughness);
  }
  writer.add_colour({"base", "base colour of the diffuse light: its albedo is base * (1 - largest F)", "reflectance, 1"}, base);
  writer.add_colour({"specular", "F0: the microfacets' reflectance seen and lit along the normal, Fresnel by Schlick up to specular_factor", "reflectance, 1"}, specular);
  writer.add_numbers({"specular_factor", "what F becomes at grazing angles, at least specular", "1"}, factor, 1.0);
  writer.add_numbers({"roughness", "roughness r of glTF: GGX with alpha = r^2", "1"}, roughness, 1.0);
  writer.add_numbers({"metallic", "metalness of glTF: none, coloured and strong highlights stand in specular", "1"},
                     Image(atlas.width, atlas.height, 1), 1.0);
}

float largest(const Image& image) { return std::max(*std::max_element(image.data.begin(), image.data.end()), 1e-6f); }

Image plane(const Image& image, int channel) {
  Image one(image.width, image.height, 1);
  for (std::size_t t = 0; t < one.data.size(); ++t) {
    one.data[t] = image.data[t * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel)];
  }
  return one;
}

Image clusters_of(const Model& model) {
  Image clusters(model.width, model.height, 1);
  std::transform(model.material.begin(), model.material.end(), clusters.data.begin(),
                 [](std::int16_t material) { return material == Model::kNoMaterial ? kNoCluster : static_cast<float>(material); });
  return clusters;
}

void add_measured(MapWriter& writer, const Model& model) {
  writer.add_clusters({"cluster", "index of the texel's material in the model; 65535 (PNG: 255) where there is none", "index"}, clusters_of(model));
  for (int k = 0; k < model.weights.channels; ++k) {
    const std::string name = "weight_" + std::to_string(k);
    const Image weight = plane(model.weights, k);
    writer.add_numbers({name.c_str(), "weight of this basis BRDF of the texel's material", "1"}, weight, largest(weight));
  }
  writer.add_numbers({"uncertainty", "one sigma of the texel's reflectance, relative; PNG clipped at 1", "1"}, model.uncertainty, 1.0);
  writer.add_numbers({"samples", "how many photographs' samples the texel was fitted to; 0 where it is filled in from its neighbours", "samples"},
                     model.samples, largest(model.samples));
}

}  // namespace

void write_map_files(const std::filesystem::path& directory, const Model& model, const RefittedAtlas& atlas, const ConversionLoss& loss) {
  MapWriter writer(directory);
  writer.come_from("the refitted material");
  add_material(writer, atlas);
  writer.come_from("the model: EXR without loss");
  writer.add_vectors({"normal_world", "shading normal in the mesh's own axes; the mesh's where the texel has none of its own", "unit vector"},
                     atlas.normals.world);
  writer.add_vectors({"normal_tangent",
                      "the same in the mesh's tangent frame: red along growing u, green up in the picture, blue the mesh's normal (MikkTSpace, OpenGL convention)",
                      "unit vector"},
                     atlas.normals.tangent);
  add_measured(writer, model);
  write_ply(directory / "mesh.ply", model.mesh);
  const json document = {{"width", model.width}, {"height", model.height}, {"rows", "top first"},
                         {"texel_centre", "u = (x + 0.5) / width, v = 1 - (y + 0.5) / height"}, {"mesh", "mesh.ply"}, {"length_unit", "metre"},
                         {"conversion_loss", loss_json(loss)},
                         {"conversion_loss_of", "the refitted material and normals as PNG, against the model's own rendering"}, {"maps", writer.entries()}};
  write_whole_file(directory / "maps.json", document.dump(1) + "\n");
}

}  // namespace lumitexel
