// What a fit found out on its way, beside the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/fit/fit_options.h"
#include "processing/fit/indirect_worth.h"
#include "processing/fit/normals_worth.h"
#include "processing/fit/outliers.h"
#include "processing/fit/stage_errors.h"
#include "processing/fit/stage_timer.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

// What left-out samples said of alternatives while materials were fitted once.
struct FitChoices {
  std::string fit;  // "on the mesh's normals", the first; "on fitted normals", "without light between surfaces", "round 2", ...
  std::vector<Choice> choices;
};

// Light between the object's surfaces.
struct IndirectSummary {
  double albedo = 0;              // largest of any triangle (indirect_bound.h)
  double largest_bound = 0;       // of any lumitexel (indirect_bound.h)
  std::size_t concerned = 0;      // lumitexels where it can matter
  std::size_t samples = 0;        // of theirs, that were followed in the last round
  double share = 0;               // of these samples' reflectance that was taken out
  int rounds_taken = 0;           // after which it was taken out, anew each time
  std::optional<IndirectWorth> worth;  // nothing: nobody asked
  std::vector<double> change;     // rms of what each round would change, over the rms of these samples; empty: not needed
  std::size_t dropped_paths = 0;  // that were not finite
};

struct FitSummary {
  std::size_t lumitexels = 0, samples = 0, unseen_triangles = 0, starved = 0;  // starved: lumitexels without samples;
                                                                               // as the last stage saw them
  LayoutSummary layout;
  RejectionCounts rejected;
  RejectedSamples unusable;          // gathered, but not finite or below the surface
  ErrorModel error;                  // that the fit started from, or was given
  ErrorSource errors = ErrorSource::Given;  // whose error models the materials have, never Auto
  BrdfFamily family = BrdfFamily::Lafortune;     // of the materials' lobes
  LobeShapes lobe_shapes = LobeShapes::Shared;   // never Auto
  std::vector<FitChoices> choices;               // of each fit, in their order
  std::vector<std::size_t> texels_by_material, texels_before_normals;  // the second only where normals were fitted
  std::vector<std::size_t> lobes_by_material;    // that its samples asked for
  std::vector<PriorChoice> prior;    // per material, of the last stage
  std::vector<std::size_t> bases_by_material;  // how many BRDFs its texels mix
  StageError single, cluster, projection;
  std::optional<StageError> pfa;     // if principal functions were asked for
  std::optional<StageError> normal;  // if normals were fitted
  std::optional<NormalsWorth> normals_worth;  // if left-out photographs were asked
  std::optional<double> normal_sigma_scale;      // if normals were fitted (sigma_scale.h)
  std::optional<IndirectSummary> indirect;       // if light between surfaces was looked for
  Outliers outliers;                 // under the finished model
  std::optional<ErrorModel> outlier_error;  // that they were told by, where not by each material's own
  std::vector<StageCost> stages;
};

}  // namespace lumitexel
