// What cameras write beside their dials, as numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lumitexel {

// Seconds: "1/250", "0.0040s", "2.5", "30", "30\"", "1 1/3", "0,3". Empty for whatever is no time by itself: "bulb",
// "auto", "Time", "x 200", "0".
std::optional<double> parse_exposure_s(const std::string& choice);

// "100", "ISO 100"; empty for "Auto", "Hi 1", "Lo 0.3", "0".
std::optional<double> parse_iso(const std::string& choice);

// How far a dial's text may be from the number meant: "1/30" for 0.0333 s, "0.3" for 0.3333 s it may not. Far less than
// the third of a stop (26 %) between a dial's places.
inline constexpr double kDialTolerance = 0.01;

// Whether both mean the same place on a dial: within kDialTolerance of each other, relatively.
bool same_choice(double a, double b);

// The choice nearest to `wanted` that is same_choice() with it; empty if there is none.
std::optional<std::string> find_choice(const std::vector<std::string>& choices,
                                       std::optional<double> (*parse)(const std::string&), double wanted);

}  // namespace lumitexel
