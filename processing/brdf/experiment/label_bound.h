// How many lumitexels of the five-material experiment anybody could label rightly: those whose true material is the most probable one
// given all that can be known, the five BRDFs, their shares and the law of the noise.
#pragma once

#include "processing/brdf/experiment/five_materials.h"

namespace lumitexel {

// Share of lumitexels labelled rightly under the very law that make_five_materials drew from. No method is better but by luck.
double bayes_accuracy(const FiveMaterials& world);

// The same for one who takes the noise for normal of the same variance and outliers for a wide normal: the best that a clustering with
// such error models can reach. Uniform noise tells more, since a material that it cannot explain at all is out.
double accuracy_by_normal_noise(const FiveMaterials& world);

}  // namespace lumitexel
