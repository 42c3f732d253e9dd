// Which lamps a shot wants lit.
#pragma once

#include "rig/shot.h"

namespace lumitexel {

struct Lighting {
  bool point = false, ring = false, back = false;
  bool operator==(const Lighting&) const = default;
};

Lighting lighting_of(ShotKind kind);

}  // namespace lumitexel
