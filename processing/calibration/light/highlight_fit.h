// The centre of one highlight, to a small part of a pixel.
//
// A highlight on a sphere is a few pixels wide, and a mosaic samples it at a quarter (red, blue) or half (green) of
// them, so a centroid would follow the mosaic. Instead a peak of elliptical shape, averaged over each pixel's area,
//   balance[c] * (background + amplitude * w(p) * (1 + |L t(p)|^2 / b)^-b)
// (from b = 2, a rough GGX mirror's, to b = 16, nearly a Gaussian; b is fitted too; L lower triangular), is fitted by
// weighted least squares. Saturated and defective pixels are left out, so a clipped core is found by its flanks.
//
// In the picture's plane t(p) = p - centre and w = 1. On a known sphere the peak is symmetric about the normal n0 that
// mirrors the light, not about its pixel: t(p) is then the normal at p across n0, times the sphere's radius in pixels,
// and w(p) = 1 / cos(normal, view) as in every microfacet model. Ignoring this moves a centre by about a thousandth of
// its distance from the sphere's, always inwards, which over six spheres adds up to millimetres of the light's
// distance. It holds for spheres whose roughness, not the lens's blur, makes the width.
//
// Several emitters whose reflections run into one (a ring flash, a lamp of some size) are fitted as that many peaks of known offsets and
// shares: the nearer one is the brighter one, which moves their centroid by a share of the ring's image.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/sphere_reflection.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {

using ColourBalance = std::array<double, 3>;  // a lamp's response per mosaic colour, relative to green (mono: unused)

struct FittedHighlight {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0;   // per axis: the pixels' noise carried through the fit, more where its residuals are beyond what it allows
  double amplitude = 0;  // of green or mono, in the image's unit
  ColourBalance balance{1, 1, 1};
  double width_px = 0;  // 1 / sqrt(det L): a scale radius
  double exponent = 2;  // b
  Eigen::Matrix2d spread_px2 = Eigen::Matrix2d::Zero();  // inverse of L^T L, in t's plane: u^T spread u is the width along u, squared
};

// The peak's integral over t's plane, of green or mono, in the image's unit times px^2: on a sphere proportional to the light's
// intensity over its squared distance, whatever widens the peak (roughness, the lens, the light's own size).
double flux_of(const FittedHighlight& fit);

struct SphereInView {
  CameraModel camera;
  MirrorSphere sphere;  // in the camera's frame
};

struct HighlightPeak {
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();  // from the centre, in t's plane
  double share = 1;                                     // of the whole highlight's light, beside the others' shares
};

struct HighlightShape {
  std::optional<SphereInView> sphere;  // symmetric on this sphere; none: in the picture's plane
  std::vector<HighlightPeak> peaks{};     // none: one, at the centre
  std::vector<Eigen::Vector2d> others_px{};  // other highlights; pixels nearer to one of them than to the start are left out
  std::optional<double> exponent{};          // b where it is known, between 1 and 16; none: fitted
};

// t of a normal on the sphere when the highlight's centre is at the pixel: a peak's offset there. None if the pixel is
// off the sphere.
std::optional<Eigen::Vector2d> across_centre(const SphereInView& view, const Eigen::Vector2d& centre_px,
                                             const Eigen::Vector3d& normal);

// Fits within `reach_px` around `start`. Without a balance the three amplitudes are free (mosaics only). None if too
// few usable pixels are there, the fit does not converge, or it ends outside the window or wider than it.
std::optional<FittedHighlight> fit_highlight(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px,
                                             const std::optional<ColourBalance>& balance,
                                             const HighlightShape& shape = {});

}  // namespace lumitexel
