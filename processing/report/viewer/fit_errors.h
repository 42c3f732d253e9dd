// By which error models a fit weighed its samples, as its model keeps them.
#pragma once

#include <optional>
#include <vector>

#include "processing/model/model.h"

namespace lumitexel {

// One entry a material.
struct FitErrors {
  std::vector<ErrorModel> weights;    // of the samples in the least squares for a texel's weights
  std::vector<ErrorModel> residuals;  // by whose scales outliers were told (outliers.h)
};

// Of the last stage's materials. Nothing for a model of before they were kept whose errors were estimated, or that the paper's method made.
std::optional<FitErrors> errors_of_fit(const Model& model);

}  // namespace lumitexel
