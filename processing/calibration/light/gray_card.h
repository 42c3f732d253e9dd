// Absolute scale: the point light's intensity per channel from the gray card's radiance.
//
// A diffuse card of albedo a at X with normal n has radiance L = a / pi * I * cos(theta) / |P - X|^2 under a light of
// intensity I at P. Every pixel well inside the card's picture gives I; a robust mean over them is the result.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct GrayCardIntensity {
  std::vector<double> intensity;       // per channel, in the radiance's unit times m^2 (times sr)
  std::vector<double> relative_sigma;  // of the mean, from the scatter of the pixels
  std::vector<double>
      pixel_scatter;  // relative standard deviation of single pixels: shadows, dirt, a tilted card show here
  std::vector<std::int64_t> pixels;  // used, per channel
};

// `card` is the merged gray-card bracket, `light_in_rig` where the light stood. The card's picture is inset by 15 % of
// its edge on every side against blur and a misplaced card. Flagged pixels are left out. Throws BadInput if the card
// is out of the picture, faces away from camera or light, or has no usable pixels in some channel.
GrayCardIntensity measure_gray_card(const MosaicRadiance& card, const CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_rig, const GrayCardDescription& description,
                                    const Eigen::Vector3d& light_in_rig);

}  // namespace lumitexel
