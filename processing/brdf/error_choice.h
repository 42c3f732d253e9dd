// Whether materials' own residuals make good error models, or hide what they cannot explain.
//
// Where BRDFs explain samples down to noise, estimated error models and robust fits are the efficient ones. Where the mesh's normals are
// wrong or the family is not the material's, a highlight is missed or hit by samples of one material, residuals are skewed and as large as
// the signal; a robust fit then takes the highlight for an outlier, and renders too dark. Which of the two it is shows in samples that
// were left out. Left out of what: of the choice which material a lumitexel is. The lumitexels should be others than those that the materials
// have learnt from. They count as independent, although neighbours share a mesh's wrong normals: that makes the choice surer of itself
// than it should be.
#pragma once

#include "processing/brdf/mixture.h"

namespace lumitexel {

// Mixtures learnt from the same lumitexels, judged by `lumitexels`, the most cautious first: the index of the one to keep. A later one
// takes an earlier one's place only if it predicts left-out samples (left_out_error.h) better by half a percent and by more than twice the
// paired difference's standard error, and none
// of the two kinds of error is larger by as much: to be wrong about it costs little one way, a model without its highlights the other.
std::size_t best_predictor(const std::vector<const Mixture*>& mixtures, const Observations& observations,
                           const LumitexelList& lumitexels);

}  // namespace lumitexel
