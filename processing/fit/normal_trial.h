// The trial that says whether normals are to be fitted (normals_worth.h): on some 40,000 lumitexels, without every fifth photograph. Materials are
// learnt on the mesh's normals, normals found with these, and materials learnt anew on them: all without what is left out.
#pragma once

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

NormalsWorth try_normals(const CalibratedSession& session, const FitInputs& inputs);

}  // namespace lumitexel
