#include "processing/calibration/light/highlight_shots.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace lumitexel {
namespace {

// What a fit cannot know of itself: profile and pixel response differ from the model's. On rendered spheres of rough metal rings and
// points err by 0.0025 rms a coordinate, noise included; where they are worse, the highlights' misfit to the spheres says so, and every sigma grows with it.
constexpr double kSystematicPx = 0.003;

void note_others(SeenInView& seen) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (j != i) seen[i].others_px.push_back(seen[j].blob.pixel);
    }
  }
}

}  // namespace

void fit_highlights(const MosaicRadiance& image, std::size_t view, const std::optional<ColourBalance>& balance,
                    const ShapeOf& shape, SeenInView& seen) {
  for (SeenHighlight& highlight : seen) {
    HighlightShape own = shape(view, highlight);
    own.others_px = highlight.others_px;
    highlight.fit = fit_highlight(image, highlight.blob.pixel, kHighlightReach_px, balance, own);
  }
}

std::vector<SeenInView> find_highlights(std::size_t views, const PictureOf& picture,
                                        const FindIn& find, const ShapeOf& shape, const std::function<void()>& step) {
  std::vector<SeenInView> seen(views);
  tbb::parallel_for(std::size_t{0}, views, [&](std::size_t v) {
    const MosaicRadiance image = picture(v);
    seen[v] = find(v, image);
    note_others(seen[v]);
    fit_highlights(image, v, std::nullopt, shape, seen[v]);
    step();
  });
  return seen;
}

void refit_highlights(const PictureOf& picture, const ShapeOf& shape,
                      std::vector<SeenInView>& seen) {
  std::vector<FittedHighlight> fits;
  for (const SeenInView& view : seen) {
    for (const SeenHighlight& highlight : view) {
      if (highlight.fit) fits.push_back(*highlight.fit);
    }
  }
  const std::optional<ColourBalance> balance = colour_balance(fits);
  if (!balance) return;
  tbb::parallel_for(std::size_t{0}, seen.size(), [&](std::size_t v) {
    if (!seen[v].empty()) fit_highlights(picture(v), v, balance, shape, seen[v]);
  });
}

HighlightPixel highlight_pixel_of(int sphere, const FittedHighlight& fit) {
  const double flux = flux_of(fit);
  return {sphere, fit.pixel, std::hypot(kSystematicPx, fit.sigma_px), {flux * fit.balance[0], flux * fit.balance[1], flux * fit.balance[2]}};
}

}  // namespace lumitexel
