// AprilTags (family tag36h11) in a photograph, their corners measured in the linear radiance.
//
// libapriltag finds and reads them in an 8-bit picture; its corners are the start. Then the four edges between the
// black border and the white margin are fitted together: near an edge, away from the corners, the radiance is
//   black + (white(t) - black) * Phi(d / blur),
// d the distance from the straight line between two corners, t the place along it, Phi the integral of a Gaussian;
// unknown are the eight coordinates, the blur, one black and the white at each corner (light that falls off). A
// Gaussian stands for lens and pixel area together.
//
// Distortion bends the edges: at radius r from the centre, k1 bends one of L pixels by about (3/8) k1 (r / f) L^2 / f,
// which is 0.01 to 0.05 px for the tags of a calibration board. Where the lens is known the bend is taken from it;
// where not, corners are that far off and the stated sigma does not hold it. To calibrate a lens from tags: detect,
// calibrate, and both once more with the lens that came out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct DetectedTag {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners_px;   // in the order of TagDescription::corners()
  Eigen::Matrix<double, 8, 8> covariance_px2;  // of x0, y0, x1, …; neighbours share an edge and are correlated
  double sigma_px = 0;                         // per axis: root of the mean of the covariance's diagonal
  double blur_px = 0;                          // standard deviation of the edges' profile
  double reduced_chi2 = 0;                  // of the edges' fit; far above 1: the edges are not straight or not clean
  std::array<Eigen::Vector2d, 4> found_px;  // libapriltag's own corners, for comparison
};

// In ascending order of id. Tags smaller than 12 pixels, cut by the picture's edge or read with more than one wrong bit
// are left out, and so are those whose edges cannot be fitted (saturated, covered) or move by more than a tenth of the
// tag. The same id may come twice if there are two such tags.
std::vector<DetectedTag> detect_tags(const MosaicRadiance& image, const std::optional<CameraModel>& lens = {});

}  // namespace lumitexel
