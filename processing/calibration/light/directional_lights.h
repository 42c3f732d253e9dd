// Directions and strengths of distant lights from a diffuse ball's shading, whose normals are known.
//
// Every pixel has an albedo of its own; lights and the shading's constants (ball_shading.h) are common to all. A
// non-linear least squares fit with a heavy-tailed loss (shadows of dust, scratches) finds all of them. Constants that the
// pictures do not ask for stay at their defaults: `choose_terms` takes each only if it predicts pixels that were held out
// better.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/calibration/light/ball_shading.h"

namespace lumitexel {

struct BallPixel {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  std::vector<double> code;  // one a light, 0 … 1; from kClippedCode on it counts as clipped and is left out
  int block = 0;             // pixels of one block may have errors in common
};
inline constexpr double kClippedCode = 0.98;

struct ShadingTerms {
  bool response = false, ambient = false, roughness = false, gloss = false;
};

struct DirectionalLights {
  std::vector<Eigen::Vector3d> directions;  // unit
  std::vector<double> strengths;            // relative to the first
  std::vector<double> sigma_rad;            // of each direction, per axis; 0 if the directions were held fixed
  BallShading shading;
  double rms_code = 0;  // of the residuals, clipped pixels left out
  bool converged = false;
};

struct LightFitOptions {
  ShadingTerms terms;
  bool fix_directions = false;
};

// start: unit directions, good to some 20 degrees. Sigmas by the sandwich formula over blocks, so that errors which the
// pixels of a block share count as one. Throws BadInput if the numbers of codes and directions differ, a code is not
// finite, or there are fewer pixels than 20.
DirectionalLights fit_directional_lights(const std::vector<BallPixel>& pixels,
                                         const std::vector<Eigen::Vector3d>& start, const LightFitOptions& options);

// Every picture's code at every pixel predicted from that pixel's other pictures (they give its albedo): rms error, lit
// and unclipped pixels only.
double prediction_rms(const DirectionalLights& lights, const std::vector<BallPixel>& pixels);

struct ChosenLights {
  ShadingTerms terms;
  DirectionalLights lights;
  double heldout_rms = 0;
  std::vector<double> tried_rms;  // held out: none, then with each term of the order response, roughness, gloss, ambient
};

// Adds terms in that order, each kept if it lowers the prediction error on `heldout` by 2 % or more.
ChosenLights choose_terms(const std::vector<BallPixel>& pixels, const std::vector<BallPixel>& heldout,
                          const std::vector<Eigen::Vector3d>& start, bool fix_directions = false);

}  // namespace lumitexel
