// What left-out samples said of one alternative, kept so that a reader of the fit sees how clear its choices were.
#pragma once

#include <string>
#include <vector>

namespace lumitexel {

// Who judges, each taken as independent of the others. Lumitexels are many, and too sure where neighbours err alike; photographs are few.
enum class Judges { Lumitexels, Photographs };

// Sum over judges of a - b, and its standard error. Of lumitexels the one that it would have if in truth there were no difference (rms about
// zero: a clear difference widens it, too). Of photographs the one about their mean, since with rms about zero five would have to agree before two
// standard errors are had; those where both are zero were not asked.
struct PairedDifference {
  double sum = 0, sigma = 0;
};
PairedDifference paired_difference(const std::vector<double>& a, const std::vector<double>& b, Judges judges = Judges::Lumitexels);

// How much less the later of two candidates errs on the same left-out samples, as a share of the earlier one's error.
struct Gain {
  double share = 0, sigma = 0;
};

// Of errors per judge, the same judges in both.
Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier, Judges judges = Judges::Lumitexels);

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
