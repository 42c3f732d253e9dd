// The settings of a fit between which `lumitexel tradeoff` lets the user's own session decide.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/fit/fit_options.h"

namespace lumitexel {

inline constexpr const char* kStandardSetting = "standard";  // that the others are compared with

struct TradeoffSetting {
  std::string name;  // "learning-5000"
  std::string what;  // in words, against the standard preset
  FitOptions options;
  std::size_t fit_views = 0;  // 0: all
  int pixel_block = 1;        // photographs to fit are binned by it, to so many times larger pixels
};

// The presets, and the standard preset with one thing changed at a time. `only`: these and no others, in the list's order;
// if empty, all but the reference preset. `full`: the reference preset too. Throws BadInput on a name that is not in the list, and lists them.
// materials: of every setting but those that are about them; nothing: as the presets have it, as many as the samples ask for, and
// kMaterialsOfThePaper for the paper's method, which does not choose. 0: the same, without the paper's method, or BadInput if it is asked for.
std::vector<TradeoffSetting> tradeoff_settings(std::optional<int> materials, bool full, const std::vector<std::string>& only);

}  // namespace lumitexel
