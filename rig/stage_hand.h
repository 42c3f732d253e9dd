// What stands before the camera beside the rig's own parts, and who puts it there.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "rig/shot.h"

namespace lumitexel {

struct Prop {
  enum class Kind {
    Nothing,   // neither of the two below: the object stands on the table
    Board,     // the calibration board, the object taken away; placement 1, 2, …
    Diffuser,  // an evenly lit diffuser before the lens
  };
  Kind kind = Kind::Nothing;
  int placement = 0;  // of a board; else 0
  bool operator==(const Prop&) const = default;
};

// What a shot needs. Darks need Nothing, since the diffuser is lit by lamps that are not ours.
Prop prop_for(const Shot& shot);

std::string to_string(const Prop& prop);                            // "object", "board 3", "diffuser"
std::optional<Prop> prop_from_string(const std::string& text);     // empty for any other text
std::string instruction_for(const Prop& prop);                      // to an operator: what to put where

class StageHand {
 public:
  virtual ~StageHand() = default;
  // Returns once it stands. Throws Timeout, Disconnected, Protocol, Cancelled.
  virtual void place(const Prop& prop, std::stop_token stop) = 0;
};

}  // namespace lumitexel
