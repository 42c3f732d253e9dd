#include "processing/render/splat.h"

#include <tbb/parallel_for.h>

#include "processing/render/lamp_light.h"
#include "processing/render/splat_screen.h"
#include "processing/render/surface_points.h"
#include "processing/render/texel_brdf.h"

namespace lumitexel {
namespace {

// Drawn so many times finer than asked for and averaged, so that outlines cover parts of pixels; odd, so that a centre
// stays one.
constexpr int kFiner = 3;

std::vector<Splat> lit_splats(const Model& model, const View& view, const std::vector<Light>& lamps, FitStage stage) {
  const ModelSurface surface(model);
  const ReflectingModel reflecting(model, stage);
  const std::vector<SurfacePoint> points = surface_points(model);
  const Eigen::Vector3d eye = view.camera_in_world();
  std::vector<Splat> splats(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024), [&](const auto& range) {
    TexelReflection texel(reflecting);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const TexturedPoint point = textured(model, points[i]);
      splats[i].on_screen = project(view, point, points[i], splats[i]);
      const Eigen::Vector3d wo = (eye - point.position_in_world).normalized();
      if (!splats[i].on_screen || !splats[i].faces_camera) continue;
      if (!texel.set(points[i].x, points[i].y, surface.shading_normal(point.texels[0], point), wo)) continue;
      splats[i].radiance = light_of_lamps(surface, point, texel, lamps);
    }
  });
  return splats;
}

View finer_view(View view) {
  CameraModel& camera = view.camera;
  camera.width_px *= kFiner;
  camera.height_px *= kFiner;
  for (double* length_px : {&camera.focal_x_px, &camera.focal_y_px, &camera.principal_x_px, &camera.principal_y_px}) {
    *length_px *= kFiner;
  }
  return view;
}

void average(const SplatView& fine, SplatView& result) {
  Image& image = result.radiance;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (int i = 0; i < kFiner * kFiner; ++i)
          sum += fine.radiance.at(kFiner * x + i % kFiner, kFiner * y + i / kFiner, c);
        image.at(x, y, c) = static_cast<float>(sum / (kFiner * kFiner));
      }
      const std::size_t centre = fine.radiance.offset(kFiner * x + kFiner / 2, kFiner * y + kFiner / 2) /
                                 static_cast<std::size_t>(image.channels);
      result.hit[image.offset(x, y) / static_cast<std::size_t>(image.channels)] = fine.hit[centre];
    }
  }
}

SplatView empty_view(const View& view, int channels) {
  SplatView result{Image(view.camera.width_px, view.camera.height_px, channels), {}, 0, 0};
  result.hit.resize(static_cast<std::size_t>(view.camera.width_px) * static_cast<std::size_t>(view.camera.height_px));
  return result;
}

}  // namespace

SplatView splat(const Model& model, const View& view, const std::vector<Light>& lamps, FitStage stage) {
  check_lamps(view, lamps, model.channels);
  const View finer = finer_view(view);
  const std::vector<Splat> splats = lit_splats(model, finer, lamps, stage);
  SplatView fine = empty_view(finer, model.channels), result = empty_view(view, model.channels);
  draw_splats(finer, splats, fine);
  average(fine, result);
  result.points = static_cast<std::int64_t>(splats.size());
  result.shown = fine.shown;
  return result;
}

}  // namespace lumitexel
