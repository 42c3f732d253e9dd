// How far texels of one material differ: the prior on their weights.
#pragma once

namespace lumitexel {

// One-sigma of a texel's relative deviation from its material. Both infinite: the paper's plain least squares.
// Either may be zero only with the other: then nothing varies.
struct TexelPrior {
  double diffuse_width = 0.4, gloss_width = 0.1;
};

inline bool nothing_varies(const TexelPrior& prior) { return prior.diffuse_width <= 0.0 && prior.gloss_width <= 0.0; }

}  // namespace lumitexel
