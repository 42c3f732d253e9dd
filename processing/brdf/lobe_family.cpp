#include "processing/brdf/lobe_family.h"

#include <cmath>

namespace lumitexel {

LobeShape LobeFamily::shape(double log_shape, double aim) const {
  return {log_shape, aim, std::exp(log_shape), aims ? lafortune_aim(aim) : LafortuneAim{}};
}

const LobeFamily& lobe_family(BrdfFamily family) {
  switch (family) {
    case BrdfFamily::Lafortune: return kLafortuneFamily;
    case BrdfFamily::Ggx: return kGgxFamily;
    case BrdfFamily::Ward: return kWardFamily;
  }
  return kLafortuneFamily;
}

}  // namespace lumitexel
