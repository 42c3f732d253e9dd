// What left-out samples said of one alternative, kept so that a reader of the fit sees how clear its choices were.
#pragma once

#include <string>
#include <vector>

namespace lumitexel {

// Sum over lumitexels of a - b, and the standard error that it would have if in truth there were no difference (rms about zero: a clear
// difference widens it, too). The lumitexels are taken as independent, which makes it too small where neighbours err alike.
struct PairedDifference {
  double sum = 0, sigma = 0;
};
PairedDifference paired_difference(const std::vector<double>& a, const std::vector<double>& b);

// How much less the later of two candidates errs on the same left-out samples, as a share of the earlier one's error.
struct Gain {
  double share = 0, sigma = 0;
};

// Of errors per lumitexel, the same lumitexels in both.
Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier);

// What a richer model has to gain: half a percent, since two models differ by chance, and surely, since every sample errs a little less; and two
// standard errors.
inline constexpr double kLeastGainShare = 0.005, kGainStandardErrors = 2.0;
inline bool is_sure(const Gain& gain) { return gain.share > kGainStandardErrors * gain.sigma; }  // false of what is no number
inline bool worth_having(const Gain& gain) { return gain.share > kLeastGainShare && is_sure(gain); }

struct Choice {
  std::string of;                // what was chosen, in words: "errors"
  std::string candidate, before;  // "estimated", over "given"
  Gain gain;
  bool taken = false;            // by the criterion of that choice, which may ask for more than a gain, or for less
};

}  // namespace lumitexel
