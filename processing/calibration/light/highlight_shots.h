// Highlights in the shots of all views: found, fitted, and fitted again with the colours that they have in common.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "processing/calibration/light/highlight_fit.h"
#include "processing/calibration/light/highlight_geometry.h"
#include "processing/calibration/light/sphere_highlights.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct SeenHighlight {
  int sphere = 0;  // place along the line
  Blob blob;
  std::optional<FittedHighlight> fit;
  std::vector<Eigen::Vector2d> others_px{};  // the view's other highlights, whoever's light they are: what lies nearer to one is left to it
};
using SeenInView = std::vector<SeenHighlight>;

using PictureOf = std::function<MosaicRadiance(std::size_t view)>;  // called from several threads
using FindIn = std::function<SeenInView(std::size_t view, const MosaicRadiance&)>;
// Called from several threads.
using ShapeOf = std::function<HighlightShape(std::size_t view, const SeenHighlight&)>;

// Fits every highlight of one view; without a balance, with free colours.
void fit_highlights(const MosaicRadiance& image, std::size_t view, const std::optional<ColourBalance>& balance,
                    const ShapeOf& shape, SeenInView& seen);

// Finds highlights in every view's shot, notes each one's others, and fits them with free colours. step: called once a shot.
std::vector<SeenInView> find_highlights(std::size_t views, const PictureOf& picture,
                                        const FindIn& find, const ShapeOf& shape, const std::function<void()>& step);

// Fits them again, with the lamp's balance of colours that all of them have in common.
void refit_highlights(const PictureOf& picture, const ShapeOf& shape,
                      std::vector<SeenInView>& seen);

inline constexpr int kHighlightReach_px = 8;  // of a fit's window about the blob

// A fit's place, what is to be believed of it, and its light.
HighlightPixel highlight_pixel_of(int sphere, const FittedHighlight& fit);

}  // namespace lumitexel
