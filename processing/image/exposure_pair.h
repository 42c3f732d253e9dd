// Two exposures of one scene compared: the bins of a photon-transfer curve.
#pragma once

#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

struct DarkedExposure {
  const Frame* frame = nullptr;
  const MasterDark* dark = nullptr;
};

struct DifferenceBin {
  double signal_dn = 0;           // mean of the merged signal, on the longer exposure's scale
  double median_dn = 0;           // the trimmed mean of d = ratio * x1 - x2
  double variance_dn2 = 0;        // of d about it, trimmed and corrected
  double pixels = 0, trimmed = 0;
};

struct PairBins {
  double ratio = 1;  // a = t2 / t1 >= 1
  std::vector<DifferenceBin> bins;
};

// Equal numbers of pixels a bin, ordered by what their neighbours see; pixels that may be clipped or are hot are left out. Whether one
// may be clipped is asked of its merged signal, not of its samples. Bins of fewer than 200 pixels are not made.
PairBins difference_bins(const DarkedExposure& shorter, const DarkedExposure& longer, const LinearSensor& sensor,
                         int bins);

// The raw values of pixels that must be saturated in `longer`, as `shorter` expects a quarter more than what
// clips.
std::vector<std::uint16_t> saturated_samples(const DarkedExposure& shorter, const DarkedExposure& longer,
                                             const LinearSensor& sensor);

}  // namespace lumitexel
