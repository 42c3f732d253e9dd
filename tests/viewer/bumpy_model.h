// Models for comparing pictures: everything that a model may hold, on a form that shades itself.
#pragma once

#include "processing/model/model.h"

namespace lumitexel {

// All families, sharp lobes, two materials, weights and normals that change from texel to texel, holes in the atlas.
Model bumpy_model();
// Also with a layer of its own for the stages before normals: other materials, fewer of them, other patches, weights and bases.
Model layered_model();

}  // namespace lumitexel
