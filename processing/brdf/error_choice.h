// Whether materials' own residuals make good error models, or hide what they cannot explain.
//
// Where BRDFs explain samples down to noise, estimated error models and robust fits are the efficient ones. Where the mesh's normals are
// wrong, a highlight is missed or hit by samples of one material, residuals are skewed and as large as the signal; a robust fit then
// takes the highlight for an outlier, and renders too dark. Which of the two it is shows in samples that were left out.
#pragma once

#include "processing/brdf/mixture.h"

namespace lumitexel {

// Fits every material to one half of its lumitexels in both ways and compares, on the other half, squared errors of predicted
// reflectance as a rendering shows them (both clipped at the 99.9th percentile). False if the estimated ones are worse by more
// than twice the difference's standard error (over lumitexels, whose samples err together).
bool estimated_errors_serve(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                            const MaterialFitOptions& options);

}  // namespace lumitexel
