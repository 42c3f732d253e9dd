#include "tests/viewer/bumpy_model.h"

#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

Brdf lobed_brdf(BrdfFamily family, double red, double green, double blue, double strength, double shape) {
  Brdf brdf = diffuse_brdf(red, green, blue);
  brdf.family = family;
  Lobe lobe;
  lobe.log_strength = std::log(strength);
  lobe.log_shape = std::log(shape);
  brdf.lobes.push_back({lobe, lobe, lobe});
  return brdf;
}

// A sphere pressed in and drawn out, so that parts of it shade others.
Mesh bumpy_mesh() {
  Mesh mesh = sphere_mesh(120, 60);
  for (Eigen::Vector3d& p : mesh.positions) p *= 1.0 + 0.3 * std::sin(5.0 * p.x()) * std::sin(4.0 * p.y() + 1.0) * std::cos(3.0 * p.z());
  return mesh;
}

}  // namespace

Model bumpy_model() {
  Model model = model_of(bumpy_mesh(), 256, 128, lobed_brdf(BrdfFamily::Ggx, 0.05, 0.1, 0.08, 0.3, 0.2));
  const Brdf sharp = lobed_brdf(BrdfFamily::Lafortune, 0.1, 0.05, 0.02, 20.0, 3000.0), soft = lobed_brdf(BrdfFamily::Lafortune, 0.02, 0.05, 0.1, 0.3, 8.0);
  const Brdf ward = lobed_brdf(BrdfFamily::Ward, 0.0, 0.1, 0.0, 0.2, 0.15);
  Brdf retro = soft;
  retro.lobes[0][0].aim = -0.5;
  retro.lobes[0][1].log_strength = -std::numeric_limits<double>::infinity();
  retro.lobes[0][2].aim = 1.2;
  model.materials = {{soft, {sharp, soft, retro, diffuse_brdf(0.1, 0.1, 0.1), ward}, {sharp, soft}},
                     {ward, {ward, model.single, retro, soft, sharp}, {retro, ward}}};
  model.weights = Image(256, 128, 5);
  model.projection_weights = Image(256, 128, 2);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      auto& material = model.material[static_cast<std::size_t>(y) * 256 + static_cast<std::size_t>(x)];
      material = static_cast<std::int16_t>((x / 32 + y / 32) % 2);
      if (x % 64 < 3 && y % 32 < 5) material = Model::kNoMaterial;
      for (int k = 0; k < 5; ++k) model.weights.at(x, y, k) = static_cast<float>(std::max(0.0, std::sin(0.05 * x * (k + 1) + 0.1 * y + k)));
      for (int k = 0; k < 2; ++k) model.projection_weights.at(x, y, k) = static_cast<float>(0.5 + 0.5 * std::cos(0.1 * x + k));
      const double longitude = 2.0 * std::numbers::pi * (x + 0.5) / 256, latitude = std::numbers::pi * (0.5 - (y + 0.5) / 128);
      const Eigen::Vector3d tilted = Eigen::Vector3d(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)) +
                                     0.1 * Eigen::Vector3d(std::sin(0.3 * x), std::cos(0.2 * y), std::sin(0.1 * x + 0.2 * y));
      for (int c = 0; c < 3; ++c) model.normal.at(x, y, c) = y % 50 < 10 ? 0.0f : static_cast<float>(tilted.normalized()[c]);
    }
  }
  // Not about the origin: what the page draws about the mesh's centre has to be moved there.
  for (Eigen::Vector3d& p : model.mesh.positions) p += Eigen::Vector3d(3.0, -2.0, 5.0);
  return model;
}

Model layered_model() {
  Model model = bumpy_model();
  ReflectanceLayer before{{model.materials[1]}, model.material, Image(256, 128, 3), Image(256, 128, 1)};
  before.materials[0].brdf = lobed_brdf(BrdfFamily::Ggx, 0.02, 0.02, 0.1, 0.5, 0.3);
  before.materials[0].basis.resize(3);
  before.materials[0].projection_basis = {model.materials[0].basis[1]};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      auto& material = before.material[static_cast<std::size_t>(y) * 256 + static_cast<std::size_t>(x)];
      if (material != Model::kNoMaterial) material = x % 100 < 4 ? Model::kNoMaterial : 0;
      for (int k = 0; k < 3; ++k) before.weights.at(x, y, k) = static_cast<float>(std::max(0.0, std::cos(0.03 * x * (k + 1) + 0.2 * y)));
      before.projection_weights.at(x, y, 0) = static_cast<float>(0.6 + 0.4 * std::sin(0.1 * y));
    }
  }
  model.before_normals = before;
  // After normals, principal functions are not sought again.
  model.projection_weights = Image();
  for (ModelMaterial& material : model.materials) material.projection_basis.clear();
  return model;
}

}  // namespace lumitexel
