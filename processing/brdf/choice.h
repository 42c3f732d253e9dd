// What left-out samples said of one alternative, kept so that a reader of the fit sees how clear its choices were.
#pragma once

#include <string>
#include <vector>

namespace lumitexel {

// How much less the later of two candidates errs on the same left-out samples, as a share of the earlier one's error; sigma: standard error
// that the paired difference would have if in truth there were none (rms about zero: a clear gain widens it, too). The lumitexels are taken
// as independent, which makes it too small where neighbours err alike.
struct Gain {
  double share = 0, sigma = 0;
};

// Of errors per lumitexel, the same lumitexels in both.
Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier);

struct Choice {
  std::string of;                // what was chosen, in words: "errors"
  std::string candidate, before;  // "estimated", over "given"
  Gain gain;
  bool taken = false;            // by the criterion of that choice, which may ask for more than a gain, or for less
};

}  // namespace lumitexel
