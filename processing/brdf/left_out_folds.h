// Lumitexels with some of their photographs left out: what is shown, and what is to be predicted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "processing/brdf/mixture.h"

namespace lumitexel {

// Both hold the lumitexels of a list, in its order, and each sample with its photograph.
struct PhotographFold {
  Observations shown, left_out;
};

// How many photographs the lumitexels have samples of; 0 where nobody knows (Observations::view).
std::size_t photographs_of(const Observations& observations, const LumitexelList& lumitexels);

// Every `folds`th photograph is left out, beginning with number `fold`, counted among those that the session has.
PhotographFold photograph_fold(const Observations& observations, const LumitexelList& lumitexels, std::size_t fold, std::size_t folds);

}  // namespace lumitexel
