// Coarser levels of a model's maps (section 10 of the paper), for pictures in which a pixel covers many texels. A level is a model of its
// own, of the final stage alone: an older reader, or one that wants no levels, ignores them.
//
// averaged   needs the model alone. The reflectance of a texel is linear in its weights, so the mean over the texels that it replaces is
//            exact, also where they are of different materials: every material of a level mixes the bases of all materials. Texels without samples
//            of their own count only where there is nothing else. Normals are averaged and made unit vectors again; that bumps smaller
//            than a texel broaden a highlight is lost.
// refitted   lumitexels of the coarser texels, a sample being the mean over the part of the surface that the texel covers, view by view: weights and
//            normals fitted to them with the materials of the model, each texel of the material that most of its parts are. What bumps do to
//            highlights is in the samples, and goes into weights as far as the bases can show it.
#pragma once

#include <filesystem>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/surface/coarser_layout.h"
#include "processing/surface/lumitexel.h"
#include "rig/progress.h"

namespace lumitexel {

inline constexpr int kMostLevels = 8;

// One texel for 2^level x 2^level. A mesh's own layout stays as it is; an atlas cut from photographs is packed anew, see coarser_layout.h.
CoarserLayout level_layout(const Model& model, int level);

Model averaged_level(const Model& model, int level);

// Lumitexels of the model's own texels, which coarser ones are put together from: once for all levels. Throws as gather_lumitexels.
LumitexelSet texel_lumitexels(const Model& model, const CalibratedSession& session, Progress& progress);

// Means over the parts of each coarser texel, in order of texel. A view gives a sample where at least half of the parts have one: less is the rim
// of a shadow or of the object. Position and normal are the parts' mean.
LumitexelSet coarser_lumitexels(const LumitexelSet& parts, const CoarserLayout& layout);

// averaged: of the same level; fine: texel_lumitexels of the model.
Model refitted_level(const Model& model, const Model& averaged, const LumitexelSet& fine, const CalibratedSession& session, int level);

// Where a model keeps its levels: MODEL/levels/1 and so on, each written by write_model.
std::filesystem::path levels_directory(const std::filesystem::path& model);
std::filesystem::path level_directory(const std::filesystem::path& model, int level);

}  // namespace lumitexel
