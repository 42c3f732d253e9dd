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

// Highlights of point lights on each sphere of the line: the brightest compact thing on its disc, then what is at least a
// thirtieth as bright (the spheres' images of their neighbours and of the bench are dimmer), at most six. Spheres without any are left out.
std::vector<std::pair<int, Blob>> find_point_highlights(const std::vector<Blob>& blobs, const CameraModel& camera,
                                                        const SphereLine& line);

// Median over highlights of the lamp's colour balance, each fitted with free amplitudes (ones for mono). None without
// any.
std::optional<ColourBalance> colour_balance(const std::vector<FittedHighlight>& free_fits);

}  // namespace lumitexel
