// An atlas cut from the photographs: triangles that share their best view form patches, and a patch lies in the atlas
// exactly as it lies in that photograph, shifted by whole pixels. A texel of the atlas is a pixel of a photograph, so
// the best image is never resampled.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct AtlasPatch {
  int view = 0;                      // index into session.views
  int shift_x = 0, shift_y = 0;      // atlas texel = photograph pixel + shift
};

struct Atlas {
  int width = 0, height = 0;
  Mesh mesh;                         // session.mesh with vertices split at seams and texture coordinates; same triangle order
  std::vector<AtlasPatch> patches;
  std::vector<int> patch_of_triangle;  // index into patches; -1 for triangles that no view sees
  static constexpr int kUnseenTexel = 0;  // (0, 0): where all unseen triangles point
};

// best_view: from choose_best_views. Throws Error if the patches do not fit into 16384 x 16384 texels.
Atlas make_atlas(const CalibratedSession& session, const std::vector<int>& best_view);

}  // namespace lumitexel
