#include "rig/lighting.h"

namespace lumitexel {

Lighting lighting_of(ShotKind kind) {
  switch (kind) {
    case ShotKind::Silhouette: return {false, false, true};
    case ShotKind::Board:
    case ShotKind::SpheresRing: return {false, true, false};
    case ShotKind::SpheresPoint:
    case ShotKind::Object:
    case ShotKind::LampPattern:
    case ShotKind::GrayCard: return {true, false, false};
    case ShotKind::FlatField:
    case ShotKind::Dark: break;
  }
  return {};
}

}  // namespace lumitexel
