// The trial that says whether normals are to be fitted (normals_worth.h): on some 40,000 lumitexels, without every fifth photograph; where
// these few do not decide, the other fifths in turn. Materials are learnt on the mesh's normals, normals found with these, and materials
// learnt once more on them: a broad lobe learnt on wrong normals becomes a sharp one. Both times the fit's own materials, adapted, are a
// candidate, so that a search that ends badly does not decide about normals. That these have seen the left-out photographs favours neither.
#pragma once

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

NormalsWorth try_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials);

}  // namespace lumitexel
