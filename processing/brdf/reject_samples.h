// The gate before the fits: samples whose numbers no fit may meet.
#pragma once

#include "processing/brdf/observations.h"

namespace lumitexel {

// Takes out samples with a number that is not finite or a variance below zero, and those whose light or view is not above the surface,
// where no lobe is defined; lumitexels stay, if need be without samples. Returns how many went, by reason.
RejectedSamples reject_unusable(Observations& observations);

}  // namespace lumitexel
