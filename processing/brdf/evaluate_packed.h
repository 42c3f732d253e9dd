// One BRDF at many geometries at once, in float: for labelling, projection and rendering, where a fit's last digits do not matter.
//
// Lafortune keeps within 3e-7 of f where f is above a tenth of the lobe's peak, and within 1.2e-6 of max(f, peak / 1000) elsewhere, for
// N from 0.01 to 1e5 and every aim, unless N < 1 and the base is below 1e-8; GGX and Ward within 3e-6 of max(f, what the lobe is with
// the half vector on the normal / 1000). Values over 1e37 or under 1e-37 do not fit.
//
// The same bytes whatever the processor: every fused multiply-add is written out, and none is left to the compiler.
#pragma once

#include <span>

#include "processing/brdf/brdf.h"
#include "processing/brdf/packed_geometries.h"

namespace lumitexel {

enum class VectorWidth { Scalar, Avx2, Avx512 };
VectorWidth widest_vectors();  // that this processor has

// values[c * geometries.size() + i]: f in channel c at geometry i, 1/sr; 0 below the surface. brdf.channels * size() values.
void evaluate(const Brdf& brdf, const PackedGeometries& geometries, std::span<float> values);
// The same with vectors of a given width, which the processor must have.
void evaluate(const Brdf& brdf, const PackedGeometries& geometries, std::span<float> values, VectorWidth width);

// One Lafortune lobe and its slopes by ln N and by aim, strength included; within ten times the errors above, relative to the slope
// where that is more than f, unless N < 2 and the base is below 1e-8.
struct PackedSlopes {
  std::span<float> value, by_log_shape, by_aim;  // geometries.size() each; the slope by ln(strength) is the value
};
void lafortune_slopes(const Lobe& lobe, const PackedGeometries& geometries, const PackedSlopes& slopes, VectorWidth width);

}  // namespace lumitexel
