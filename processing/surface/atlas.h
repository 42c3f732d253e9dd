// An atlas cut from the photographs: triangles that share their best view form patches, and a patch lies in the atlas
// as it lies in that photograph, shifted by whole pixels. A texel's centre is a pixel's centre of its best photograph, and its
// lumitexel is the surface point that this pixel's ray meets: the best image is not resampled.
//
// Whoever looks the model up interpolates texture coordinates linearly over a triangle, which a perspective picture with a
// distorting lens is not quite. Where that would miss the pixel's centre by over kLookUpTolerance anywhere in a triangle (large ones, close
// to the camera), its lumitexels lie where the texel is looked up instead, and the best photograph is read between pixels like any other.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/surface/layout_sites.h"

namespace lumitexel {

inline constexpr double kLookUpTolerance = 0.1;  // texels; less than the mesh's own error or a lens's blur moves a picture

struct AtlasPatch {
  int view = 0;                      // index into session.views
  int shift_x = 0, shift_y = 0;      // atlas texel = photograph pixel + shift
};

struct Atlas {
  int width = 0, height = 0;
  Mesh mesh;                         // session.mesh with vertices split at seams and texture coordinates; same triangle order
  std::vector<AtlasPatch> patches;
  std::vector<int> patch_of_triangle;  // index into patches; -1 for triangles that no view sees
  // Lumitexels that lie at their texel's centre as the texture coordinates have it, rather than at a photograph's pixel; in order of texel.
  // Their triangles have none at pixels.
  std::vector<LayoutSite> sites{};
  std::vector<std::uint8_t> at_texel{};  // one entry a triangle: 1 where `sites` has its lumitexels
  // Texels that only unseen triangles look up, which get the most common material. The first is (0, 0), where all of them point, in an atlas cut from photographs.
  std::vector<std::uint32_t> unseen_texels{0};
};

// best_view: from choose_best_views. Throws Error if the patches do not fit into 16384 x 16384 texels.
Atlas make_atlas(const CalibratedSession& session, const std::vector<int>& best_view);

}  // namespace lumitexel
