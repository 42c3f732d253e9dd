// How bright a ball's surface looks under a distant light: no more than Lambert's cosine, and what a scene may add to it.
//
//   code = L^(1 / gamma),   L = strength * (albedo * s(n, l) + gloss(n, l)) + ambient
// with s = max(0, n . l) times Oren and Nayar's factor for Gaussian facets (their qualitative model, "Generalization of
// Lambert's reflectance model", 1994, whose roughness is the slopes' angle in radians; 0: Lambert), and gloss a broad lobe
// height * exp(-tan^2(n, h) / width^2) about the half vector h. Directions in the frame of ball_in_picture.h: the viewer
// is along z. Codes and radiances run from 0 to 1.
#pragma once

#include <Eigen/Core>

namespace lumitexel {

struct BallShading {
  double gamma = 1.0;      // of the camera's response; 1: linear
  double ambient = 0.0;    // radiance that every pixel has under every light
  double roughness = 0.0;  // rad
  double gloss = 0.0;      // height of the lobe
  double gloss_width = 0.4;

  // The code that a surface of this albedo and normal gives.
  double code(const Eigen::Vector3d& normal, const Eigen::Vector3d& light, double albedo, double strength) const;
};

}  // namespace lumitexel
