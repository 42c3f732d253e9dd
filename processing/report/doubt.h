// What a texel's uncertainty mostly comes from, so that one knows what would help: other photographs, another lamp, a better mesh.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model_surface.h"

namespace lumitexel {

// Asked in this order; the first that holds is the cause.
enum class Doubt {
  Normal,       // turning the normal by one sigma changes the predictions for the point's photographs by more, rms, than the stated sigma
  NoHighlight,  // the material has a highlight, and no photograph that sees the point lit is near it
  FewSamples,   // fewer samples than the material has basis functions to mix
  Scatter       // else: noise of the samples, and what the material's functions cannot describe
};
inline constexpr std::array<Doubt, 4> kDoubts{Doubt::Normal, Doubt::NoHighlight, Doubt::FewSamples, Doubt::Scatter};
const char* to_string(Doubt doubt);  // "normal", "no highlight", "few samples", "scatter"

// Nothing where the point's nearest texel was not fitted to samples. Highlights, and which photographs are near one: processing/brdf/highlight.h.
std::optional<Doubt> doubt_at(const ModelSurface& surface, const CalibratedSession& session, const TexturedPoint& point);

struct DoubtfulPoint {
  int material = 0;
  Doubt doubt = Doubt::Scatter;
};
// Of `count` points spread evenly over the mesh's area, those that were measured. Deterministic.
std::vector<DoubtfulPoint> doubts_over_surface(const ModelSurface& surface, const CalibratedSession& session, int count);

}  // namespace lumitexel
