// Whether materials' own residuals make good error models, or hide what they cannot explain.
//
// Where BRDFs explain samples down to noise, estimated error models and robust fits are the efficient ones. Where the mesh's normals are
// wrong, a highlight is missed or hit by samples of one material, residuals are skewed and as large as the signal; a robust fit then
// takes the highlight for an outlier, and renders too dark. Which of the two it is shows in samples that were left out.
#pragma once

#include "processing/brdf/mixture.h"

namespace lumitexel {

// Two mixtures learnt from the same lumitexels, with the error model given and with error models estimated. True only if the estimated one
// predicts left-out samples (left_out_error.h) better by more than twice the paired difference's standard error: to be wrong about it costs
// little one way, a model without its highlights the other.
bool estimated_errors_serve(const Mixture& given, const Mixture& estimated, const Observations& observations,
                            const LumitexelList& lumitexels);

}  // namespace lumitexel
