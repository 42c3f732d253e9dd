// Whether materials' own residuals make good error models, or hide what they cannot explain.
//
// Where BRDFs explain samples down to noise, estimated error models and robust fits are the efficient ones. Where the mesh's normals are
// wrong or the family is not the material's, a highlight is missed or hit by samples of one material, residuals are skewed and as large as
// the signal; a robust fit then takes the highlight for an outlier, and renders too dark. Which of the two it is shows in samples that
// were left out. Left out of what: of the choice which material a lumitexel is. The lumitexels should be others than those that the materials
// have learnt from. They count as independent, although neighbours share a mesh's wrong normals: that makes the choice surer of itself
// than it should be.
#pragma once

#include <string>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/left_out_error.h"

namespace lumitexel {

// What a mixture has to show against the best one before it. All by left-out samples (left_out_error.h), in the sum of the two kinds of
// error, each a share of the earlier one's; SE: the paired difference's standard error over the judges (choice.h).
enum class Claim {
  Better,    // a gain of over 2 SE, and no loss of as much in either kind: to be wrong about it costs little one way, a model without its
             // highlights the other
  Richer,    // that, and half a percent of gain: richer models, and materials sought anew, differ from those before by chance, and surely,
             // since every sample errs a little less
  Efficient  // no loss in either kind of over two percent, or, by 2 SE, of over half a percent. For fits by estimated errors: where they predict as well, they
             // are the more exact ones. A hundredth of the samples, outliers, may make up most of an error, so that no gain would show
};

// A mixture by its name, and how it predicted what was left out: an entry a judge.
struct Predictor {
  std::string name;
  const std::vector<SquaredError>* errors;
};

// Of mixtures learnt from the same lumitexels and judged by the same others, the most cautious first: the index of the one to keep. A later
// one takes an earlier one's place where the claim holds, one that predicts numbers always that of one that does not. What each comparison said is added to `choices`, as a choice of `of`.
std::size_t best_predictor(const std::string& of, const std::vector<Predictor>& predictors, Claim claim, std::vector<Choice>& choices,
                           Judges judges = Judges::Lumitexels);

}  // namespace lumitexel
