#include "tests/viewer/viewer_likeness.h"

#include <algorithm>
#include <cmath>

#include "processing/model/render_view.h"

namespace lumitexel {
namespace {

constexpr double kWhiteFraction = 0.99;

double white_of(const Image& image) {
  std::vector<float> lit;
  std::copy_if(image.data.begin(), image.data.end(), std::back_inserter(lit), [](float value) { return value > 0.0f; });
  if (lit.empty()) return 0.0;
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(kWhiteFraction * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return *at;
}

}  // namespace

Likeness likeness(const ModelSurface& surface, const View& view, FitStage stage, const BrowserPicture& picture) {
  const Model& model = surface.model();
  const Image reference = ViewRenderer(model).render(view, {stage, 1}).radiance;
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  Likeness result;
  result.white = white_of(reference);
  double squares = 0.0;
  for (int y = 0; y < view.camera.height_px; ++y) {
    for (int x = 0; x < view.camera.width_px; ++x) {
      const std::size_t at = std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(view.camera.width_px) + static_cast<std::size_t>(x));
      const auto point = surface.trace(world_from_camera.translation(), world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5}));
      const bool drawn = picture.radiance[at + 3] > 0.0f;
      if (point.has_value() != drawn) ++result.other_outline;
      if (!point || !drawn) continue;
      ++result.object_pixels;
      if (point->texel_count == 0) continue;
      const TexelShare& texel = nearest_texel(*point);
      if (static_cast<int>(picture.texel[at]) != texel.x || static_cast<int>(picture.texel[at + 1]) != texel.y) continue;
      ++result.same_texel;
      for (int c = 0; c < model.channels; ++c) {
        const double difference = static_cast<double>(picture.radiance[at + static_cast<std::size_t>(c)]) - static_cast<double>(reference.at(x, y, c));
        squares += difference * difference;
        result.worst = std::max(result.worst, std::abs(difference) / result.white);
      }
    }
  }
  const double mean = squares / (static_cast<double>(result.same_texel) * model.channels);
  result.psnr_db = 10.0 * std::log10(result.white * result.white / mean);
  return result;
}

}  // namespace lumitexel
