#include "processing/export/conversion_loss.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "processing/export/tangent_frame.h"
#include "processing/image/exr_file.h"

namespace lumitexel {
namespace {

constexpr int kSize_px = 400;

// Everything has a material here: a texture knows no holes.
Model textured_shell(const Model& model) {
  Model shell;
  shell.mesh = model.mesh;
  shell.width = model.width;
  shell.height = model.height;
  shell.material.assign(model.material.size(), 0);
  return shell;
}

GltfMaterial filtered(const ExportedMaps& maps, const TexturedPoint& point) {
  GltfMaterial sum;
  sum.roughness = sum.specular = 0.0;
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& share = point.texels[static_cast<std::size_t>(i)];
    const GltfMaterial texel = decoded_texel(maps, share.x, share.y);
    const std::array<double, 3> colour = decoded_highlight_share(maps, share.x, share.y);
    // Mitsuba's texture holds alpha, roughness^2.
    sum.roughness += share.weight * (maps.form == MaterialForm::Mitsuba ? texel.roughness * texel.roughness : texel.roughness);
    sum.specular += share.weight * texel.specular;
    for (std::size_t c = 0; c < 3; ++c) {
      sum.base[c] += share.weight * texel.base[c];
      sum.f0[c] += share.weight * colour[c];
    }
  }
  if (maps.form == MaterialForm::Mitsuba) sum.roughness = std::sqrt(sum.roughness);
  for (double& f0 : sum.f0) f0 *= sum.specular;  // each texture is filtered, then they meet
  return sum;
}

// Textures' normals are filtered as they are stored, and brought to length 1 where they are used.
Eigen::Vector3d shading_normal(const ExportedMaps& maps, const Mesh& mesh, const std::vector<Eigen::Vector4d>& tangents,
                               const TexturedPoint& point) {
  if (maps.normal.channels == 0) return point.vertex_normal;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& share = point.texels[static_cast<std::size_t>(i)];
    sum += share.weight * decoded_normal(maps.normal, share.x, share.y);
  }
  const Eigen::Matrix3d frame = maps.form == MaterialForm::Gltf ? tangent_frame(mesh, tangents, point.triangle, point.u, point.v)
                                                                : triangle_frame(mesh, point.triangle, point.u, point.v);
  return (frame * sum).normalized();
}

}  // namespace

Image render_exported(const Model& model, const ExportedMaps& maps, const View& view) {
  const Model shell = textured_shell(model);
  const ModelSurface surface(shell);
  const std::vector<Eigen::Vector4d> tangents = vertex_tangents(model.mesh);
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  const Eigen::Vector3d eye = world_from_camera.translation();
  Image radiance(view.camera.width_px, view.camera.height_px, model.channels);
  tbb::parallel_for(0, radiance.height, [&](int y) {
    for (int x = 0; x < radiance.width; ++x) {
      const auto point = surface.trace(eye, world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5}));
      if (!point || !surface.sees(*point, view.light)) continue;
      const Eigen::Vector3d at = point->position_in_world;
      const LobeGeometry geometry = lobe_geometry(shading_normal(maps, model.mesh, tangents, *point), view.light.direction_from(at), (eye - at).normalized());
      if (geometry.cos_i <= 0.0) continue;
      // Mitsuba's normalmap gives no light where the mesh's own normal turns away from it.
      if (maps.form == MaterialForm::Mitsuba && point->vertex_normal.dot(view.light.direction_from(at)) <= 0.0) continue;
      const ChannelValues f = evaluate(maps.form, filtered(maps, *point), geometry);
      for (int c = 0; c < model.channels; ++c) {
        radiance.at(x, y, c) =
            static_cast<float>(f[static_cast<std::size_t>(c)] * geometry.cos_i * view.light.irradiance(at, c));
      }
    }
  });
  return radiance;
}

std::vector<View> conversion_views(const Mesh& mesh, int channels) {
  const Eigen::Vector3d sides[] = {{1, 0.1, 0.3}, {-1, 0.1, 0.3}, {0.1, 1, 0.3}, {0.1, -1, 0.3}, {0.2, 0.1, 1}, {0.2, 0.1, -1}};
  Eigen::Vector3d low = mesh.positions.front(), high = low;
  for (const Eigen::Vector3d& position : mesh.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const Eigen::Vector3d middle = 0.5 * (low + high);
  std::vector<View> views;
  for (const Eigen::Vector3d& side : sides) {
    const Eigen::Vector3d up = std::abs(side.z()) < 0.5 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    View view = framing_view(mesh, channels, kSize_px, side, up);
    views.push_back(view);
    // The same distance as the camera's, 70 degrees to its side: grazing light, highlights far from the retro direction.
    const double distance_m = (view.camera_in_world() - middle).norm();
    const Eigen::Vector3d beside = up.cross(side).normalized();
    view.light.vector_in_world = middle + distance_m * (0.342 * side.normalized() + 0.940 * beside);
    views.push_back(view);
  }
  return views;
}

ConversionLoss conversion_loss(const Model& model, const ExportedMaps& maps, Progress& progress) {
  const ViewRenderer renderer(model);
  const std::vector<View> views = conversion_views(model.mesh, model.channels);
  progress.begin("comparing renderings", static_cast<std::int64_t>(views.size()), "views");
  ErrorSums sums;
  ConversionLoss loss;
  for (const View& view : views) {
    const RenderedView reference = renderer.render(view, {});
    sums.add(render_exported(model, maps, view), reference.radiance, reference.hit);
    progress.update(++loss.views);
  }
  loss.error = sums.error();
  return loss;
}

void write_reference(const std::filesystem::path& path, const Model& model, const View& view) {
  RenderOptions options;
  options.samples_per_pixel = 16;
  write_exr_colour(path, ViewRenderer(model).render(view, options).radiance);
}

}  // namespace lumitexel
