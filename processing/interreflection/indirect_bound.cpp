#include "processing/interreflection/indirect_bound.h"

#include <algorithm>
#include <cmath>

#include "processing/brdf/ordered_sum.h"
#include "processing/interreflection/form_factors.h"
#include "processing/render/texel_brdf.h"

namespace lumitexel {
namespace {

constexpr double kMostAlbedo = 0.95;  // a fitted BRDF may reflect more than it gets, no surface does

double albedo_of(const Brdf& brdf) {
  ChannelValues sum{};
  for (const ReflectingPart& part : ReflectingBrdf(brdf).parts) {
    const ChannelValues own = part.albedo(std::sqrt(0.5));
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += own[c];
  }
  return *std::max_element(sum.begin(), sum.end());
}

// At the lumitexel: the mesh's vertices' values between them.
float interpolated(const std::vector<float>& at_vertex, const Mesh& mesh, const RayScene& scene, const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal) {
  const double offset_m = scene.surface_offset_m();
  const auto hit = scene.closest(position + 2.0 * offset_m * normal, -normal);
  if (!hit || hit->distance_m > 10.0 * offset_m) return 1.0f;  // nobody knows: whatever there is may matter
  const auto& corner = mesh.triangles[hit->triangle];
  return static_cast<float>((1.0 - hit->u - hit->v) * static_cast<double>(at_vertex[corner[0]]) +
                            hit->u * static_cast<double>(at_vertex[corner[1]]) + hit->v * static_cast<double>(at_vertex[corner[2]]));
}

}  // namespace

std::vector<float> triangle_albedos(const Model& model) {
  std::vector<float> of_material;
  for (const ModelMaterial& material : model.materials) of_material.push_back(static_cast<float>(std::min(kMostAlbedo, albedo_of(material.brdf))));
  std::vector<float> albedos;
  for (const auto& triangle : model.mesh.triangles) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const std::uint32_t corner : triangle) middle += model.mesh.texcoords[corner] / 3.0;
    const int x = std::clamp(static_cast<int>(middle.x() * model.width), 0, model.width - 1);
    const int y = std::clamp(static_cast<int>((1.0 - middle.y()) * model.height), 0, model.height - 1);
    const int material = model.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x)];
    albedos.push_back(material == Model::kNoMaterial ? 0.0f : of_material[static_cast<std::size_t>(material)]);
  }
  return albedos;
}

std::vector<float> indirect_bounds(const LumitexelSet& lumitexels, const Mesh& mesh, const RayScene& scene,
                                   const std::vector<float>& triangle_albedo) {
  const std::vector<float> factor = facing(mesh, scene, triangle_albedo);
  const double largest = factor.empty() ? 0.0 : static_cast<double>(*std::max_element(factor.begin(), factor.end()));
  const double gain = 1.0 / (1.0 - largest);
  std::vector<float> bounds(lumitexels.size(), 0.0f);
  if (largest == 0.0) return bounds;
  std::size_t first = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for_each_block(tile.size(), [&](std::size_t i) {
      bounds[first + i] = static_cast<float>(gain * static_cast<double>(interpolated(factor, mesh, scene, tile.position[i], tile.normal[i])));
    });
    first += tile.size();
  }
  return bounds;
}

}  // namespace lumitexel
