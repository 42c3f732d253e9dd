// Finds the spheres' highlights in the ring-flash and the point-light shots, among those of the object and the card.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/highlight_fit.h"
#include "processing/calibration/light/light_position.h"
#include "processing/calibration/light/sphere_line.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct Blob {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // intensity-weighted centroid, good to about half a pixel
  double peak = 0;
};

// Compact things brighter than their surroundings and well above the noise, at most 15 px across; the brightest first.
std::vector<Blob> compact_blobs(const MosaicRadiance& image, std::size_t most);

// The `count` blobs that can be ring highlights of spheres on a line: in undistorted directions such points lie on a
// straight line, at places that a projective map of 0, 1, 2, … gives, and are about equally bright, since
// the flash is about equally far from all. In order, beginning with the leftmost (topmost if upright). None if no such
// row is found.
std::optional<std::vector<Blob>> find_sphere_row(const std::vector<Blob>& blobs, const CameraModel& camera, int count);

// The point light's highlight on each sphere of the line, at most one each: the brightest compact thing on its disc.
// Spheres without one (the light is hidden from them, or a fit failed) are left out.
std::vector<std::pair<int, Blob>> find_point_highlights(const std::vector<Blob>& blobs, const CameraModel& camera,
                                                        const SphereLine& line);

// Median over highlights of the lamp's colour balance, each fitted with free amplitudes (ones for mono). None without
// any.
std::optional<ColourBalance> colour_balance(const std::vector<FittedHighlight>& free_fits);

}  // namespace lumitexel
