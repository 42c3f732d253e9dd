#include "processing/brdf/lobe_family.h"

namespace lumitexel {

const LobeFamily& lobe_family(BrdfFamily family) {
  switch (family) {
    case BrdfFamily::Lafortune: return kLafortuneFamily;
    case BrdfFamily::Ggx: return kGgxFamily;
    case BrdfFamily::Ward: return kWardFamily;
  }
  return kLafortuneFamily;
}

}  // namespace lumitexel
