// Light between the object's own surfaces taken out of the samples, where it can matter: predicted by the model so far, subtracted, and
// predicted anew by the model that follows, until that changes nothing more or the rounds are used up. How much of it is taken: taken_light.h.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/fit/fit_options.h"
#include "processing/fit/fit_summary.h"
#include "processing/interreflection/indirect_light.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

class IndirectRemoval {
 public:
  // Bounds first: they alone decide where paths are followed. Keeps references.
  IndirectRemoval(const CalibratedSession& session, LumitexelSet& lumitexels, const RayScene& scene, const Model& model,
                  const InterreflectionOptions& options);

  // Whether enough of the surface can get enough light from other surfaces.
  bool can_matter() const;
  // Predicts by the model at `stage`, which was fitted to the samples as they are, and takes that instead of what was taken before out of the
  // samples as photographed. Only where they change by so much that they should be fitted again: else false, and they are as they were. Variances
  // then have each sample's own scatter of its paths.
  bool remove(const Model& model, FitStage stage);
  // Before a fit: see taken_light.h.
  void even_out_variance();

  // The samples as photographed again.
  void put_back();

  const IndirectSummary& summary() const { return summary_; }
  // Of each texel: bound and share found (Model::indirect).
  Image map(int width, int height) const;

 private:
  const CalibratedSession& session_;
  LumitexelSet& lumitexels_;
  InterreflectionOptions options_;
  std::vector<float> bound_;
  std::vector<bool> wanted_;
  std::vector<std::vector<float>> measured_, measured_variance_;  // the samples as photographed, one entry a tile
  std::vector<std::vector<float>> taken_;                         // of these
  IndirectSummary summary_;
};

}  // namespace lumitexel
