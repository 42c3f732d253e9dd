#include "processing/model/render_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr float kNoMaterial = 65535.0f;  // as in cluster.exr
using Radiance = std::array<double, kMaxChannels>;

struct Eye {
  explicit Eye(const View& v) : view(v), world_from_camera(v.camera_from_world.inverse()) {}
  Eigen::Vector3d origin() const { return world_from_camera.translation(); }
  Eigen::Vector3d direction(double x, double y) const {
    return world_from_camera.linear() * view.camera.unproject({x, y});
  }
  const View& view;
  Eigen::Isometry3d world_from_camera;
};

Radiance shade(const ModelSurface& surface, const TexturedPoint& point, const Eye& eye, FitStage stage) {
  Radiance radiance{};
  const Light& light = eye.view.light;
  if (point.texel_count == 0 || !surface.sees(point, light)) return radiance;
  const Eigen::Vector3d wi = light.direction_from(point.position_in_world);
  const Eigen::Vector3d wo = (eye.origin() - point.position_in_world).normalized();
  const Model& model = surface.model();
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
    const LobeGeometry geometry = lobe_geometry(surface.shading_normal(texel, point, stage), wi, wo);
    if (geometry.cos_i <= 0.0) continue;
    for (int c = 0; c < model.channels; ++c) {
      radiance[static_cast<std::size_t>(c)] +=
          texel.weight * geometry.cos_i * evaluate_texel(model, stage, texel.x, texel.y, c, geometry);
    }
  }
  for (int c = 0; c < model.channels; ++c) {
    radiance[static_cast<std::size_t>(c)] *= light.irradiance(point.position_in_world, c);
  }
  return radiance;
}

// Hammersley's points moved to the middle of their strata: one point alone is the centre.
Eigen::Vector2d pattern_point(int index, int count) {
  double reversed = 0.0, digit = 0.5;
  for (int bits = index; bits > 0; bits >>= 1, digit *= 0.5) reversed += digit * (bits & 1);
  return {(index + 0.5) / count, reversed + 0.5 / count};
}

// The same of every row, whichever thread has it: rows are independent.
template <typename PerPixel>
void for_each_pixel(const CameraModel& camera, const PerPixel& per_pixel) {
  tbb::parallel_for(0, camera.height_px, [&](int y) {
    for (int x = 0; x < camera.width_px; ++x) per_pixel(x, y);
  });
}

Eigen::Vector3d blended_normal(const ModelSurface& surface, const TexturedPoint& point) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
    sum += texel.weight * surface.shading_normal(texel, point, FitStage::Normal);
  }
  return sum.isZero() ? point.vertex_normal : sum.normalized();
}

float material_at(const Model& model, const TexturedPoint& point) {
  if (point.texel_count == 0) return kNoMaterial;
  const TexelShare& texel = nearest_texel(point);
  return model.material[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(model.width) +
                        static_cast<std::size_t>(texel.x)];
}

double blended(const Image& map, const TexturedPoint& point) {
  double sum = 0.0;
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
    sum += texel.weight * map.at(texel.x, texel.y);
  }
  return sum;
}

void write_aov(const ModelSurface& surface, const TexturedPoint& point, Aov aov, float* out) {
  const Model& model = surface.model();
  const auto store = [out](const Eigen::Vector3d& v) { std::copy(v.data(), v.data() + 3, out); };
  if (aov == Aov::Normal) store(blended_normal(surface, point));
  if (aov == Aov::Position) store(point.position_in_world);
  if (aov == Aov::Cluster) *out = material_at(model, point);
  if (aov == Aov::Samples && point.texel_count > 0) *out = model.samples.at(nearest_texel(point).x, nearest_texel(point).y);
  if (aov == Aov::Sigma) *out = static_cast<float>(blended(model.uncertainty, point));
  if (aov == Aov::NormalSigma) *out = static_cast<float>(blended(model.normal_sigma, point));
}

}  // namespace

RenderedView ViewRenderer::render(const View& view, const RenderOptions& options) const {
  const Model& model = surface_.model();
  const CameraModel& camera = view.camera;
  if (view.light.intensity.size() != static_cast<std::size_t>(model.channels)) {
    throw BadInput(view.name + ": light", std::to_string(view.light.intensity.size()) + " channels",
                   std::to_string(model.channels) + " as the model has");
  }
  if (options.samples_per_pixel < 1) {
    throw BadInput("samples per pixel", std::to_string(options.samples_per_pixel), "1 or more");
  }
  const Eye eye(view);
  RenderedView result{Image(camera.width_px, camera.height_px, model.channels), {}};
  result.hit.resize(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for_each_pixel(camera, [&](int x, int y) {
    Radiance sum{};
    for (int s = 0; s < options.samples_per_pixel; ++s) {
      const Eigen::Vector2d offset = pattern_point(s, options.samples_per_pixel);
      const auto point = surface_.trace(eye.origin(), eye.direction(x + offset.x(), y + offset.y()));
      if (!point) continue;
      const Radiance sample = shade(surface_, *point, eye, options.stage);
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += sample[c];
    }
    for (int c = 0; c < model.channels; ++c) {
      result.radiance.at(x, y, c) = static_cast<float>(sum[static_cast<std::size_t>(c)] / options.samples_per_pixel);
    }
    const bool hit = surface_.trace(eye.origin(), eye.direction(x + 0.5, y + 0.5)).has_value();
    result.hit[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) + static_cast<std::size_t>(x)] =
        hit;
  });
  return result;
}

Image ViewRenderer::render_aov(const View& view, Aov aov) const {
  if (aov == Aov::Radiance) return render(view, {}).radiance;
  if (aov == Aov::NormalSigma && !has_normals(model())) throw BadInput("normal-sigma", "a model on its mesh's normals", "a model with fitted normals");
  const Eye eye(view);
  const int channels = aov == Aov::Normal || aov == Aov::Position ? 3 : 1;
  Image image(view.camera.width_px, view.camera.height_px, channels, aov == Aov::Cluster ? kNoMaterial : 0.0f);
  for_each_pixel(view.camera, [&](int x, int y) {
    const auto point = surface_.trace(eye.origin(), eye.direction(x + 0.5, y + 0.5));
    if (point) write_aov(surface_, *point, aov, &image.at(x, y));
  });
  return image;
}

View framing_view(const Mesh& mesh, int channels, int size_px, const Eigen::Vector3d& towards_camera,
                  const Eigen::Vector3d& up) {
  constexpr double kFieldOfViewRad = 0.5;  // long enough a lens that proportions look natural
  constexpr double kMargin = 1.05;
  Eigen::Vector3d low = mesh.positions.front(), high = low;
  for (const Eigen::Vector3d& position : mesh.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const Eigen::Vector3d centre = 0.5 * (low + high);
  double radius_m = 0.0;
  for (const Eigen::Vector3d& position : mesh.positions) radius_m = std::max(radius_m, (position - centre).norm());
  const double distance_m = kMargin * radius_m / std::sin(0.5 * kFieldOfViewRad);

  View view;
  view.name = "framing view";
  const double focal_px = 0.5 * size_px / std::tan(0.5 * kFieldOfViewRad);
  view.camera = {size_px, size_px, focal_px, focal_px, 0.5 * size_px, 0.5 * size_px};
  const Eigen::Vector3d back = towards_camera.normalized();
  const Eigen::Vector3d right = up.cross(back).normalized();
  Eigen::Matrix3d world_from_camera;
  world_from_camera << right, -back.cross(right), -back;
  const Eigen::Vector3d eye = centre + distance_m * back;
  view.camera_from_world.linear() = world_from_camera.transpose();
  view.camera_from_world.translation() = -world_from_camera.transpose() * eye;
  view.light.vector_in_world = eye + 0.3 * distance_m * (back.cross(right) + right);
  const double light_distance_m = (view.light.vector_in_world - centre).norm();
  view.light.intensity.assign(static_cast<std::size_t>(channels),
                              std::numbers::pi * light_distance_m * light_distance_m);
  return view;
}

}  // namespace lumitexel
