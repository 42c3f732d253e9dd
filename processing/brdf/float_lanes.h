// Float arithmetic that keeps twice the digits where they matter, written for a compiler to spread over vector lanes: no branches, no
// calls, every fused multiply-add explicit.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#define LUMITEXEL_LANE [[gnu::always_inline]] inline

namespace lumitexel::lanes {

struct TwoFloats {
  float high, low;  // their sum; |low| at most half a unit in the last place of high
};

inline TwoFloats two_floats(double value) {
  const float high = static_cast<float>(value);
  return {high, static_cast<float>(value - static_cast<double>(high))};
}

LUMITEXEL_LANE float fused(float a, float b, float c) { return __builtin_fmaf(a, b, c); }

LUMITEXEL_LANE TwoFloats exact_sum(float a, float b) {
  const float sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// |a| >= |b|, or a = 0.
LUMITEXEL_LANE TwoFloats ordered_sum(float a, float b) {
  const float sum = a + b;
  return {sum, b - (sum - a)};
}

// Not renormalised: low carries what high * high rounded away, and the rest.
LUMITEXEL_LANE TwoFloats product(const TwoFloats& a, const TwoFloats& b) {
  const float high = a.high * b.high;
  return {high, fused(a.high, b.high, -high) + fused(a.high, b.low, a.low * b.high)};
}

// constant + a x + b y to 48 bits of the largest term.
LUMITEXEL_LANE TwoFloats linear(const TwoFloats& constant, const TwoFloats& a, const TwoFloats& x, const TwoFloats& b, const TwoFloats& y) {
  const TwoFloats ax = product(a, x), by = product(b, y);
  const TwoFloats first = exact_sum(constant.high, ax.high), second = exact_sum(first.high, by.high);
  return ordered_sum(second.high, ((first.low + second.low) + (ax.low + by.low)) + constant.low);
}

// log2 of a positive number, as an integer plus ln(1 + w) with |w| < 0.42.
struct Logarithm {
  float exponent;
  TwoFloats log1p;
};

LUMITEXEL_LANE Logarithm logarithm(const TwoFloats& x) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(x.high);
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;  // the mantissa from sqrt(1/2) to sqrt(2)
  const float scale = std::bit_cast<float>((127 - exponent) << 23);
  const float w = std::bit_cast<float>(bits - (exponent << 23)) - 1.0f, w_low = x.low * scale;
  const float square = w * w, square_low = fused(w, w, -square);
  // (ln(1 + w) - w + w^2 / 2) / w^3, minimax, weighted by w^2: 6e-9
  float p = -0.07865483241f;
  p = fused(p, w, 0.1287921762f);
  p = fused(p, w, -0.1312529016f);
  p = fused(p, w, 0.1418141722f);
  p = fused(p, w, -0.1662497012f);
  p = fused(p, w, 0.2000228266f);
  p = fused(p, w, -0.2500079656f);
  p = fused(p, w, 0.3333331678f);
  const TwoFloats first = ordered_sum(w, -0.5f * square);
  const float slope = fused(fused(1.0f - w, w, -1.0f), w, 1.0f);  // 1 / (1 + w), near enough for the low part
  const float rest = fused(w * square, p, fused(-0.5f, square_low, first.low)) + w_low * slope;
  return {static_cast<float>(exponent), ordered_sum(first.high, rest)};
}

// 2^x; 0 where x < -126.
LUMITEXEL_LANE float power_of_two(const TwoFloats& x) {
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: adding it leaves the nearest integer in the low bits
  const float clamped = x.high > -126.0f ? (x.high < 127.0f ? x.high : 127.0f) : -126.0f;
  const float shifted = clamped + kRound, whole = shifted - kRound;
  const float part = (clamped - whole) + x.low;
  float q = 0.000153533519125f;  // (2^f - 1) / f, minimax: 2e-9
  q = fused(q, part, 0.00133988713615f);
  q = fused(q, part, 0.00961843738235f);
  q = fused(q, part, 0.0555033248144f);
  q = fused(q, part, 0.240226479136f);
  q = fused(q, part, 0.693147202848f);
  const std::int32_t exponent = std::bit_cast<std::int32_t>(shifted) - std::bit_cast<std::int32_t>(kRound);
  const float mantissa = fused(q, part, 1.0f);
  const float value = std::bit_cast<float>(std::bit_cast<std::int32_t>(mantissa) + (exponent << 23));
  return x.high < -126.0f ? 0.0f : value;
}

}  // namespace lumitexel::lanes
