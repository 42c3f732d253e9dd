// What a model predicts a photograph to be: light straight from the view's lamp, and, where the fit took light between surfaces out of the
// samples of that stage, that light as well.
#pragma once

#include "processing/model/render_view.h"

namespace lumitexel {

// Rendered at pixel centres; light between surfaces from `paths` a pixel (its noise is a third of
// it or so, which is a percent or two of the whole).
RenderedView predicted_view(const ViewRenderer& renderer, const View& view, FitStage stage, int paths = 8);

}  // namespace lumitexel
