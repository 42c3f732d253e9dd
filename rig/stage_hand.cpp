#include "rig/stage_hand.h"

#include <charconv>

namespace lumitexel {
namespace {

constexpr const char *kNothing = "object", *kDiffuser = "diffuser";
constexpr std::string_view kBoard = "board ";

}  // namespace

Prop prop_for(const Shot& shot) {
  switch (shot.kind) {
    case ShotKind::Board: return {Prop::Kind::Board, shot.index};
    case ShotKind::LampPattern: return {Prop::Kind::Board, 1};
    case ShotKind::FlatField: return {Prop::Kind::Diffuser, 0};
    case ShotKind::Silhouette:
    case ShotKind::SpheresRing:
    case ShotKind::SpheresPoint:
    case ShotKind::Object:
    case ShotKind::GrayCard:
    case ShotKind::Dark: break;
  }
  return {};
}

std::string to_string(const Prop& prop) {
  switch (prop.kind) {
    case Prop::Kind::Board: return std::string(kBoard) + std::to_string(prop.placement);
    case Prop::Kind::Diffuser: return kDiffuser;
    case Prop::Kind::Nothing: break;
  }
  return kNothing;
}

std::optional<Prop> prop_from_string(const std::string& text) {
  if (text == kNothing) return Prop{};
  if (text == kDiffuser) return Prop{Prop::Kind::Diffuser, 0};
  if (!text.starts_with(kBoard)) return std::nullopt;
  Prop board{Prop::Kind::Board, 0};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data() + kBoard.size(), end, board.placement);
  if (error != std::errc{} || stopped != end || board.placement < 1) return std::nullopt;
  return board;
}

std::string instruction_for(const Prop& prop) {
  switch (prop.kind) {
    case Prop::Kind::Board:
      return "take the object away and hold the board still before the camera, in placement " +
             std::to_string(prop.placement) + (prop.placement == 1 ? ": in the picture's middle, facing the camera"
                                                                   : ": elsewhere in the picture and tilted otherwise than before");
    case Prop::Kind::Diffuser: return "put the evenly lit diffuser before the lens";
    case Prop::Kind::Nothing: break;
  }
  return "take board and diffuser away and put the object on the table";
}

}  // namespace lumitexel
