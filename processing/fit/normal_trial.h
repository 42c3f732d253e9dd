// The trial that says whether normals are to be fitted (normals_worth.h): on some 40,000 lumitexels, without every fifth photograph; where
// these few do not decide, the other fifths in turn. Each side is what the fit would make of it: on the mesh's normals the fit's own materials,
// adapted; then normals found with these, and on them the same materials adapted or others sought anew, whichever predict better: a broad lobe
// learnt on wrong normals becomes a sharp one. That the fit's own have seen the left-out photographs favours the mesh, if anything. (The paper's
// method seeks its materials anew both times.)
#pragma once

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

NormalsWorth try_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials);

}  // namespace lumitexel
