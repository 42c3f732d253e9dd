#include "rig/shot.h"

#include <array>
#include <cstdio>
#include <utility>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::array<std::pair<ShotKind, const char*>, 9> kKindNames{{{ShotKind::Silhouette, "silhouette"},
                                                                      {ShotKind::SpheresRing, "spheres_ring"},
                                                                      {ShotKind::SpheresPoint, "spheres_point"},
                                                                      {ShotKind::Object, "object"},
                                                                      {ShotKind::GrayCard, "gray_card"},
                                                                      {ShotKind::Dark, "dark"},
                                                                      {ShotKind::Board, "board"},
                                                                      {ShotKind::FlatField, "flat_field"},
                                                                      {ShotKind::LampPattern, "lamp_pattern"}}};

}  // namespace

const char* to_string(ShotKind kind) {
  for (const auto& [value, name] : kKindNames) {
    if (value == kind) return name;
  }
  return "unknown";
}

ShotKind shot_kind_from_string(const std::string& name) {
  for (const auto& [value, known] : kKindNames) {
    if (name == known) return value;
  }
  throw Corrupt("shot kind '" + name + "' is not one of this program's");
}

std::string frame_file_name(const Shot& shot) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%06lld_", static_cast<long long>(shot.id));
  return number.data() + std::string(to_string(shot.kind)) + ".pgm";
}

}  // namespace lumitexel
