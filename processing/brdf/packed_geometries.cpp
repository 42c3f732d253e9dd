#include "processing/brdf/packed_geometries.h"

namespace lumitexel {

void PackedGeometries::reserve(std::size_t count) {
  for (auto* array : {&cos_i, &cos_o, &mirror_gap, &mirror_rest, &retro_gap, &retro_rest, &across2}) array->reserve(count);
}

void PackedGeometries::add(const LobeGeometry& g) {
  const bool lit = g.cos_i > 0.0 && g.cos_o > 0.0;
  cos_i.push_back(lit ? static_cast<float>(g.cos_i) : 0.0f);
  cos_o.push_back(static_cast<float>(g.cos_o));
  mirror_gap.push_back(static_cast<float>(g.mirror_gap));
  mirror_rest.push_back(static_cast<float>(g.mirror_gap - static_cast<double>(mirror_gap.back())));
  retro_gap.push_back(static_cast<float>(g.retro_gap));
  retro_rest.push_back(static_cast<float>(g.retro_gap - static_cast<double>(retro_gap.back())));
  across2.push_back(static_cast<float>(g.across2));
}

}  // namespace lumitexel
