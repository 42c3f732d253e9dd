// Random numbers that are a function of a key and a counter, not of what was drawn before: any pixel can be drawn
// by any thread, in any order, after any restart.
#pragma once

#include <cstdint>

namespace lumitexel {

// A bijective scrambling of 64 bits (the finaliser of SplitMix64).
std::uint64_t scrambled(std::uint64_t bits);
// The key `key` extended by one more word of identity. Order matters.
std::uint64_t extended_key(std::uint64_t key, std::uint64_t word);
std::uint64_t extended_key(std::uint64_t key, double word);  // by its bits; -0 counts as 0

// A short stream of numbers for one counter under one key.
class CounterRandom {
 public:
  CounterRandom(std::uint64_t key, std::uint64_t counter) : state_(extended_key(key, counter)) {}

  double uniform();            // in (0, 1)
  double normal();             // mean 0, variance 1
  double poisson(double mean);  // mean >= 0; above 50 a rounded Gaussian (relative error of the skewness only)

 private:
  std::uint64_t state_;
};

}  // namespace lumitexel
