// What the photographs said about every texel, for the viewer: made again from the session as the fit made it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/report/viewer/packed_chunks.h"
#include "rig/progress.h"

namespace lumitexel {

struct CarriedSamples {
  std::size_t lumitexels = 0, samples = 0;
};

// Into the document: "views" (name, camera, pose, light of all views), "used_views" (of the fit, in order), "lattice", "verdicts" (their
// names by number), "outliers" (the model's list, of texels).
// Chunks, of texels with a material in raster order: "residual" (root mean square over samples and channels of predicted minus measured r,
// 1/sr; half float), "outliers" (the model's list as text). Of the carried lumitexels, also in raster order: "lumitexel_x", "lumitexel_y", "verdict" (a byte for
// each used view), and of their samples in the order of views "reflectance" (three half floats, by channel).
// Throws BadInput if the model was not fitted to this session.
CarriedSamples add_lumitexels(const Model& model, const CalibratedSession& session, int lattice, nlohmann::json& document,
                              PackedChunks& chunks, Progress& progress);

}  // namespace lumitexel
