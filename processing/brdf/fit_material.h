// A material learnt from samples: its BRDF and its error model together, with as many lobes as the samples ask for.
#pragma once

#include <optional>

#include "processing/brdf/brdf_sigma.h"
#include "processing/brdf/fit_brdf.h"

namespace lumitexel {

struct MaterialFitOptions {
  BrdfFamily family = BrdfFamily::Lafortune;
  int most_lobes = 1;          // 0 to 3
  bool choose_lobes = true;    // false: exactly most_lobes, asked for or not
  bool shared_shape = true;
  // True: each material's error model is estimated from its own residuals, and outlying samples count less in its fit. That is
  // efficient, and right where what is left is noise. False: `error` is the last word and every sample counts, so that the fit is the
  // best mean prediction even where residuals have causes of their own, such as normals that the coarse mesh does not have.
  bool estimate_error = true;
  // If set, the BRDF is the best mean prediction under this model, while the error model, estimated, tells materials apart.
  std::optional<ErrorModel> mean_fit;
  bool any_aim = false;        // lobes may point anywhere (the paper); else near the mirror direction or back at the light
  ErrorModel error;            // where the estimate starts
};

struct MaterialModel {
  Brdf brdf;
  ErrorModel error;
};

struct MaterialFit {
  MaterialModel model;
  BrdfFit fit;                 // the last one, with the covariance
  double criterion = 0;        // misfit times independence, plus ln(n) for each parameter; lower is better
};

// Grows the BRDF from diffuse light, lobe by lobe, each forward or (from the second on) retro-reflective, whichever explains more.
// A lobe stays if it lowers the criterion: the Bayesian information criterion with the likelihood tempered by the error model's
// `independence`, since samples of one lumitexel err together, and predicts photographs left out (left_out_photographs.h). With a `start`, as many lobes as it has begin where its own are.
MaterialFit fit_material(FitSamples samples, int channels, const Brdf* start, const MaterialFitOptions& options);

// Of the BRDF that these samples were fitted by.
BrdfSigma sigma_of(const MaterialModel& model, FitSamples samples, const MaterialFitOptions& options);

// The options of a fit that keeps the number and kind of lobes of `model`.
BrdfFitOptions refit_options(const MaterialModel& model, const MaterialFitOptions& options);

}  // namespace lumitexel
