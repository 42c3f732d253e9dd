// The least squares over a turntable's views, from a start to convergence.
#pragma once

#include <vector>

#include "processing/calibration/pose/turntable_problem.h"

namespace lumitexel {

struct TurntableFitOptions {
  double start_scale_px = 3, spacing_px = 1;  // of the outline's points
  RimModel rim = RimModel::Smooth;
  double correlation = 1.0;  // as many contour points say as much as one independent one
  int max_iterations = 40;
};

struct TurntableFit {
  TurntableModel model;
  std::vector<SilhouetteEquations> silhouettes;  // at the model, a view
  TurntableWeights weights;                      // of the last iteration
  double sigma_px = 0, explained = 0;            // robust; share of the outline on the contour
  bool converged = false;
};

// Gauss-Newton with robust weights whose scale shrinks from start_scale_px to what the distances ask for.
// px_per_m: of the object in the picture.
TurntableFit fit_turntable(const TurntableProblem& problem, const TurntableModel& start, double px_per_m,
                           const TurntableFitOptions& options);

std::vector<SilhouetteEquation> all_rows(const std::vector<SilhouetteEquations>& silhouettes);
// Of the whole outline in all views.
double explained_by(const std::vector<SilhouetteEquations>& silhouettes, double scale_px);
inline constexpr std::size_t kLeastRows = 20;  // with fewer there is no fit

}  // namespace lumitexel
