// Compiled so that the compiler spreads these loops over lanes (CMakeLists.txt): once for each vector width, from the same source.
#include "processing/brdf/evaluate_packed.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "processing/brdf/packed_lobes.h"

#if defined(__x86_64__)
#define LUMITEXEL_AVX2 [[gnu::target("avx2,fma")]]
#define LUMITEXEL_AVX512 [[gnu::target("avx512f,avx512dq,avx512bw,avx512vl,fma,prefer-vector-width=512")]]
#endif

namespace lumitexel {
namespace {

using namespace lanes;

constexpr std::size_t kBlock = 256;  // stays in the first cache
constexpr float kSmallestCosine = 1e-12f;

struct Block {
  alignas(64) float gain[kBlock], offset[kBlock];
};

LUMITEXEL_LANE void lafortune_block(const Lobe& lobe, const PackedGeometries& g, std::size_t first, std::size_t count, Block& block) {
  const LafortuneLane lane(lobe.log_shape, lobe.aim);
  const float* const mirror = g.mirror_gap.data() + first;
  const float* const mirror_rest = g.mirror_rest.data() + first;
  const float* const retro = g.retro_gap.data() + first;
  const float* const retro_rest = g.retro_rest.data() + first;
  alignas(64) float high[kBlock], low[kBlock];
  for (std::size_t i = 0; i < count; ++i) {
    bool dark = false;
    const TwoFloats base = lafortune_base(lane, {mirror[i], mirror_rest[i]}, {retro[i], retro_rest[i]}, dark);
    high[i] = base.high;
    low[i] = base.low;
    block.offset[i] = 0.0f;
    block.gain[i] = dark ? 0.0f : 1.0f;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const TwoFloats power = lafortune_power(lane, {high[i], low[i]});
    high[i] = power.high;
    low[i] = power.low;
  }
  for (std::size_t i = 0; i < count; ++i) block.gain[i] *= power_of_two({high[i], low[i]});
}

LUMITEXEL_LANE void ggx_block(const Lobe& lobe, const PackedGeometries& g, std::size_t first, std::size_t count, Block& block) {
  const FacetLane lane(lobe.log_shape, true);
  const float* const cos_i = g.cos_i.data() + first;
  const float* const cos_o = g.cos_o.data() + first;
  const float* const across2 = g.across2.data() + first;
  const float* const retro = g.retro_gap.data() + first;
  for (std::size_t i = 0; i < count; ++i) {
    const float in = cos_i[i] > kSmallestCosine ? cos_i[i] : 1.0f, out = cos_o[i] > kSmallestCosine ? cos_o[i] : 1.0f;
    const LobeLane value = ggx_lobe(lane, in, out, across2[i], retro[i]);
    block.gain[i] = value.gain;
    block.offset[i] = value.offset;
  }
}

LUMITEXEL_LANE void ward_block(const Lobe& lobe, const PackedGeometries& g, std::size_t first, std::size_t count, Block& block) {
  const FacetLane lane(lobe.log_shape, false);
  const float* const cos_i = g.cos_i.data() + first;
  const float* const cos_o = g.cos_o.data() + first;
  const float* const across2 = g.across2.data() + first;
  for (std::size_t i = 0; i < count; ++i) {
    const float in = cos_i[i] > kSmallestCosine ? cos_i[i] : 1.0f, out = cos_o[i] > kSmallestCosine ? cos_o[i] : 1.0f;
    block.gain[i] = ward_lobe(lane, in, out, across2[i]);
    block.offset[i] = 0.0f;
  }
}

LUMITEXEL_LANE void lobe_block(BrdfFamily family, const Lobe& lobe, const PackedGeometries& g, std::size_t first, std::size_t count,
                               Block& block) {
  switch (family) {
    case BrdfFamily::Lafortune: return lafortune_block(lobe, g, first, count, block);
    case BrdfFamily::Ggx: return ggx_block(lobe, g, first, count, block);
    case BrdfFamily::Ward: return ward_block(lobe, g, first, count, block);
  }
}

LUMITEXEL_LANE void add_lobe(const TwoFloats& strength, const Block& block, float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = fused(strength.high, block.gain[i], fused(strength.low, block.gain[i], values[i]) + block.offset[i]);
  }
}

LUMITEXEL_LANE void evaluate_block(const Brdf& brdf, const PackedGeometries& g, std::size_t first, std::size_t count, float* values) {
  const std::size_t n = g.size(), channels = static_cast<std::size_t>(brdf.channels);
  Block block;
  for (std::size_t c = 0; c < channels; ++c) {
    std::fill_n(values + c * n + first, count, static_cast<float>(brdf.diffuse[c]));
  }
  for (const auto& lobe : brdf.lobes) {
    for (std::size_t c = 0; c < channels; ++c) {
      if (c == 0 || !lobe[c].same_shape(lobe[c - 1])) lobe_block(brdf.family, lobe[c], g, first, count, block);
      if (lobe[c].log_strength == -std::numeric_limits<double>::infinity()) continue;
      add_lobe(two_floats(std::exp(lobe[c].log_strength)), block, values + c * n + first, count);
    }
  }
  const float* const cos_i = g.cos_i.data() + first;
  for (std::size_t c = 0; c < channels; ++c) {
    float* const value = values + c * n + first;
    for (std::size_t i = 0; i < count; ++i) value[i] = cos_i[i] > 0.0f ? value[i] : 0.0f;
  }
}

LUMITEXEL_LANE void evaluate_blocks(const Brdf& brdf, const PackedGeometries& g, float* values) {
  for (std::size_t first = 0; first < g.size(); first += kBlock) {
    evaluate_block(brdf, g, first, std::min(kBlock, g.size() - first), values);
  }
}

LUMITEXEL_LANE void slopes_of(const Lobe& lobe, const PackedGeometries& g, float* __restrict value, float* __restrict by_log_shape,
                              float* __restrict by_aim) {
  constexpr float kLn2 = 0.6931471805599453f;
  const LafortuneLane lane(lobe.log_shape, lobe.aim);
  const TwoFloats strength = two_floats(std::exp(lobe.log_strength));
  const float* const cos_i = g.cos_i.data();
  const float* const mirror = g.mirror_gap.data();
  const float* const mirror_rest = g.mirror_rest.data();
  const float* const retro = g.retro_gap.data();
  const float* const retro_rest = g.retro_rest.data();
  const std::size_t count = g.size();
  for (std::size_t i = 0; i < count; ++i) {
    const TwoFloats near_mirror{mirror[i], mirror_rest[i]}, near_light{retro[i], retro_rest[i]};
    bool dark = false;
    const TwoFloats base = lafortune_base(lane, near_mirror, near_light, dark), power = lafortune_power(lane, base);
    const TwoFloats slope = linear(lane.slope_constant, lane.mirror_slope, near_mirror, lane.retro_slope, near_light);
    const float gain = power_of_two(power), lit = cos_i[i] > 0.0f && !dark ? gain : 0.0f;
    const float scaled = fused(strength.high, lit, strength.low * lit);
    value[i] = scaled;
    by_log_shape[i] = scaled * (power.high * kLn2);
    by_aim[i] = scaled * (lane.exponent.high * slope.high / base.high);
  }
}

#if defined(__x86_64__)
LUMITEXEL_AVX2 void evaluate_avx2(const Brdf& brdf, const PackedGeometries& g, float* values) { evaluate_blocks(brdf, g, values); }
LUMITEXEL_AVX512 void evaluate_avx512(const Brdf& brdf, const PackedGeometries& g, float* values) { evaluate_blocks(brdf, g, values); }
LUMITEXEL_AVX2 void slopes_avx2(const Lobe& lobe, const PackedGeometries& g, const PackedSlopes& s) {
  slopes_of(lobe, g, s.value.data(), s.by_log_shape.data(), s.by_aim.data());
}
LUMITEXEL_AVX512 void slopes_avx512(const Lobe& lobe, const PackedGeometries& g, const PackedSlopes& s) {
  slopes_of(lobe, g, s.value.data(), s.by_log_shape.data(), s.by_aim.data());
}
#endif

}  // namespace

VectorWidth widest_vectors() {
#if defined(__x86_64__)
  static const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                             __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return avx512 ? VectorWidth::Avx512 : avx2 ? VectorWidth::Avx2 : VectorWidth::Scalar;
#else
  return VectorWidth::Scalar;
#endif
}

void evaluate(const Brdf& brdf, const PackedGeometries& geometries, std::span<float> values) {
  evaluate(brdf, geometries, values, widest_vectors());
}

void evaluate(const Brdf& brdf, const PackedGeometries& geometries, std::span<float> values, VectorWidth width) {
  if (values.size() != geometries.size() * static_cast<std::size_t>(brdf.channels)) {
    throw std::invalid_argument("evaluate: wrong number of values");
  }
#if defined(__x86_64__)
  if (width == VectorWidth::Avx512) return evaluate_avx512(brdf, geometries, values.data());
  if (width == VectorWidth::Avx2) return evaluate_avx2(brdf, geometries, values.data());
#endif
  evaluate_blocks(brdf, geometries, values.data());
}

void lafortune_slopes(const Lobe& lobe, const PackedGeometries& geometries, const PackedSlopes& slopes, VectorWidth width) {
  for (const auto& array : {slopes.value, slopes.by_log_shape, slopes.by_aim}) {
    if (array.size() != geometries.size()) throw std::invalid_argument("lafortune_slopes: wrong number of values");
  }
#if defined(__x86_64__)
  if (width == VectorWidth::Avx512) return slopes_avx512(lobe, geometries, slopes);
  if (width == VectorWidth::Avx2) return slopes_avx2(lobe, geometries, slopes);
#endif
  slopes_of(lobe, geometries, slopes.value.data(), slopes.by_log_shape.data(), slopes.by_aim.data());
}

}  // namespace lumitexel
