#include "processing/evaluation/predicted_view.h"

#include "drivers/clock.h"
#include "processing/render/render_lit.h"

namespace lumitexel {

RenderedView predicted_view(const ViewRenderer& renderer, const View& view, FitStage stage, int paths) {
  const Model& model = renderer.model();
  RenderedView predicted = renderer.render(view, {stage, 1});
  if (bounces_taken_out(model, stage) == 0) return predicted;
  LitOptions options;
  options.stage = stage;
  options.path.bounces = bounces_taken_out(model, stage);
  options.path.straight_light = false;
  options.limits.samples_per_pixel = paths;
  NoProgress silent;
  const LitView between = render_lit(model, view, {{view.light}, nullptr}, options, silent, SystemClock());
  for (std::size_t i = 0; i < predicted.radiance.data.size(); ++i) predicted.radiance.data[i] += between.radiance.data[i];
  return predicted;
}

}  // namespace lumitexel
