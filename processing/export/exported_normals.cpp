#include "processing/export/exported_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "processing/export/nearest_texel.h"
#include "processing/export/tangent_frame.h"
#include "processing/render/texel_triangles.h"

namespace lumitexel {
namespace {

void store(Image& image, std::size_t texel, const Eigen::Vector3d& v) {
  for (std::size_t k = 0; k < 3; ++k) image.data[3 * texel + k] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
}

// On the triangle, where the texel's centre lies beside it.
Eigen::Vector2d on_triangle(Eigen::Vector2d at) {
  at = at.cwiseMax(0.0);
  return at.sum() > 1.0 ? at / at.sum() : at;
}

template <typename T>
std::vector<std::uint8_t> flags(const std::vector<T>& values, T none) {
  std::vector<std::uint8_t> known(values.size());
  std::transform(values.begin(), values.end(), known.begin(), [none](T value) { return value != none ? 1 : 0; });
  return known;
}

}  // namespace

ExportedNormals export_normals(const Model& model, MaterialForm form) {
  const std::vector<Eigen::Vector4d> tangents = vertex_tangents(model.mesh);
  const std::vector<std::int32_t> triangles = triangle_of_texel(model);
  const auto by_triangle = nearest_known_texel(model.width, model.height, flags(triangles, kNoTriangle));
  const auto by_material =
      nearest_known_texel(model.width, model.height, flags(model.material, static_cast<std::int16_t>(Model::kNoMaterial)));
  ExportedNormals normals{Image(model.width, model.height, 3), Image(model.width, model.height, 3)};
  double squares = 0.0;
  std::int64_t counted = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::int32_t triangle = triangles[by_triangle[t]];
    const Eigen::Vector3d own(model.normal.data[3 * t], model.normal.data[3 * t + 1], model.normal.data[3 * t + 2]);
    if (triangle == kNoTriangle) {  // no triangle has a texel: nothing to tilt against
      store(normals.tangent, t, Eigen::Vector3d::UnitZ());
      store(normals.world, t, own.isZero() ? Eigen::Vector3d::UnitZ() : own);
      continue;
    }
    const int x = static_cast<int>(t % static_cast<std::size_t>(model.width)), y = static_cast<int>(t / static_cast<std::size_t>(model.width));
    const auto face = static_cast<std::uint32_t>(triangle);
    const Eigen::Vector2d at = on_triangle(texel_barycentric(model, x, y, face));
    const Eigen::Matrix3d frame = form == MaterialForm::Gltf ? tangent_frame(model.mesh, tangents, face, at.x(), at.y())
                                                             : triangle_frame(model.mesh, face, at.x(), at.y());
    store(normals.world, t, own.isZero() ? frame.col(2) : own.normalized());
    const Eigen::Vector3d in_texture = own.isZero() ? Eigen::Vector3d::UnitZ() : in_frame(frame, own.normalized());
    store(normals.tangent, t, in_texture);
    if (model.material[t] == Model::kNoMaterial) continue;
    const double tilt_rad = std::acos(std::min(in_texture.z(), 1.0));
    squares += tilt_rad * tilt_rad;
    ++counted;
  }
  if (counted > 0) normals.tilt_rms_rad = std::sqrt(squares / static_cast<double>(counted));
  for (Image* map : {&normals.world, &normals.tangent}) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (by_material[t] != t) std::copy_n(&map->data[3 * by_material[t]], 3, &map->data[3 * t]);
    }
  }
  return normals;
}

}  // namespace lumitexel
