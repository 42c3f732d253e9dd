// --materials, which several commands have.
#pragma once

#include <string>

namespace lumitexel {

inline constexpr int kMostMaterialsAsked = 64;

// A number from 1 to 64; 0 for "auto". Throws BadInput naming the option for anything else.
int materials_wanted(const std::string& option, const std::string& text);

}  // namespace lumitexel
