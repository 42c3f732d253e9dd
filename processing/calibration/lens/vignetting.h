// The lens's fall-off towards the corners, from pictures of an even white surface.
//
// With rho the distance from the principal point over half the picture's diagonal,
//   flat = level (1 + g . (p - principal) / half diagonal) (1 + a rho^2 + b rho^4 + c rho^6).
// Level and gradient g belong to each flat alone (no illumination is quite even): a straight gradient is odd about the
// principal point and the lens's fall-off even, so the two part. Illumination that is itself curved cannot be told from
// vignetting; to turn the surface between flats shows it, because then they disagree (reduced chi square).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {

struct Vignetting {
  double principal_x_px = 0, principal_y_px = 0, half_diagonal_px = 1;
  Eigen::Vector3d terms = Eigen::Vector3d::Zero();          // a, b, c
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     // zero for terms that are not used
  double transmission(const Eigen::Vector2d& pixel) const;  // 1 at the principal point
  double sigma(const Eigen::Vector2d& pixel) const;         // of it
};

struct VignettingFit {
  Vignetting vignetting;
  int terms = 0;              // 0: the flats do not ask for any
  double reduced_chi2 = 0;    // of the cells that were kept
  double cells_left_out = 0;  // share of cells taken for dust
  bool usable = false;        // enough cells, and they determine the terms
};

// All colours together: each cell of the picture gives one relative value per colour, with a level of its own for every
// colour and flat. Terms enter by the Bayesian information criterion. Cells further than 4 sigma off are dust and left
// out with their neighbours. Throws BadInput if there is no flat, sizes differ from the camera's, or a flat has no
// variance.
VignettingFit fit_vignetting(const std::vector<MosaicRadiance>& flats, const CameraModel& camera);

// Divides by the transmission, variances by its square.
void correct_vignetting(MosaicRadiance& image, const Vignetting& vignetting);
void correct_vignetting(RadianceImage& image, const Vignetting& vignetting);

}  // namespace lumitexel
