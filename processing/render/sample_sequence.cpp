#include "processing/render/sample_sequence.h"

namespace lumitexel {
namespace {

constexpr double kTwoToMinus32 = 1.0 / 4294967296.0;

std::uint32_t mixed(
    std::uint32_t bits) {  // a bijection whose output bits all depend on all input bits (Wellons' lowbias32)
  bits = (bits ^ (bits >> 16)) * 0x7feb352du;
  bits = (bits ^ (bits >> 15)) * 0x846ca68bu;
  return bits ^ (bits >> 16);
}

std::uint32_t extended(std::uint32_t key, std::uint32_t word) { return mixed(key + 0x9e3779b9u + mixed(word)); }

std::uint32_t reversed(std::uint32_t bits) {
  bits = (bits << 16) | (bits >> 16);
  bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
  bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
  bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
  return ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
}

// Flips every binary digit by a hash of the digits above it.
std::uint32_t owen_scrambled(std::uint32_t bits, std::uint32_t seed) {
  bits = reversed(bits) + seed;
  bits ^= bits * 0x6c50b47cu;
  bits ^= bits * 0xb82f1e52u;
  bits ^= bits * 0xc7afe638u;
  bits ^= bits * 0x8d22f6e6u;
  return reversed(bits);
}

std::uint32_t sobol_second(std::uint32_t index) {  // the second dimension; the first is the reversed index
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1) {
    if ((index & 1u) != 0) result ^= direction;
  }
  return result;
}

}  // namespace

SampleSequence::SampleSequence(int x_px, int y_px, int replicate, std::uint32_t index)
    : key_(extended(extended(extended(0, static_cast<std::uint32_t>(x_px)), static_cast<std::uint32_t>(y_px)),
                    static_cast<std::uint32_t>(replicate))),
      index_(index) {}

Eigen::Vector2d SampleSequence::next() {
  const std::uint32_t key = extended(key_, pair_++);
  const std::uint32_t shuffled = owen_scrambled(index_, key);
  return {owen_scrambled(reversed(shuffled), extended(key, 1)) * kTwoToMinus32,
          owen_scrambled(sobol_second(shuffled), extended(key, 2)) * kTwoToMinus32};
}

}  // namespace lumitexel
