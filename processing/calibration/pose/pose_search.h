// Where a mesh may stand so that its outline lies on an observed contour: a search that needs no start but a rough one,
// and the refinement that ends every search.
#pragma once

#include <vector>

#include "processing/calibration/pose/silhouette_equations.h"

namespace lumitexel {

// One view, and how its mesh is to be seen.
struct ViewToRegister {
  const MeshSilhouette& mesh;
  const ContourLookup& contour;
  const CameraModel& camera;
};

struct PoseFit {
  CentredPose pose;
  SilhouetteEquations equations;  // at the pose
  double scale_px = 0;            // of the robust weights: three robust standard deviations, at least kLeastScale_px
  double explained = 0;           // share of the outline, robustly weighted, that lies on the contour
  bool converged = false;         // the last step moved no point by more than settled_px(scale_px)
  int iterations = 0;
};

inline constexpr double kLeastScale_px = 0.5;

struct RefineOptions {
  double start_scale_px = 3.0;  // distances up to some times this are believed at first
  double spacing_px = 2.0;
  int max_iterations = 40;
  RimModel model = RimModel::Smooth;
};

// A step that no longer matters: edges of facets that enter and leave an outline keep moving a rough fit by about this much.
double settled_px(double scale_px);

// Gauss-Newton on contour distances, robustly weighted, the scale shrinking from the start's to the residuals' own.
PoseFit refine_pose(const ViewToRegister& view, const CentredPose& start, const RefineOptions& options);

struct SearchRange {
  double turn_deg = 25.0;   // the true rotation is within this of the start; 180: any rotation
  double shift_m = 0.12;    // likewise the object's centre, per axis of the camera
};

double focal_px(const CameraModel& camera);  // mean of the two
double diameter_px(const ViewToRegister& view, const CentredPose& pose);  // twice the mesh's rms radius
// Share of the outline, robustly weighted at a scale, that lies on the contour.
double explained_share(const SilhouetteEquations& equations, double scale_px);

// Turns on a grid over the range; for each the best of a grid of shifts and distances by distance transforms; the most
// promising are refined with coarsely sampled outlines. Best first, no two nearer than a few degrees. Deterministic.
std::vector<PoseFit> search_pose(const ViewToRegister& view, const CentredPose& start, const SearchRange& range,
                                 RimModel model);

}  // namespace lumitexel
