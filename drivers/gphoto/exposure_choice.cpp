#include "drivers/gphoto/exposure_choice.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace lumitexel {
namespace {

// The number that the text begins with, which is then cut off; empty if it begins with none.
std::optional<double> take_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || !std::isfinite(value) || value < 0.0) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

void skip_blanks(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
}

// "250" of "1/250": what it is divided by, 1 without a stroke; empty for a stroke without a number.
std::optional<double> take_divisor(std::string_view& text) {
  if (!text.starts_with('/')) return 1.0;
  text.remove_prefix(1);
  return take_number(text);
}

}  // namespace

std::optional<double> parse_exposure_s(const std::string& choice) {
  std::string with_points = choice;
  for (char& character : with_points) character = character == ',' ? '.' : character;
  std::string_view text = with_points;
  skip_blanks(text);
  std::optional<double> whole = take_number(text), divisor = take_divisor(text);
  if (!whole || !divisor || *divisor == 0.0) return {};
  double seconds = *whole / *divisor;
  skip_blanks(text);
  if (*divisor == 1.0 && !text.empty() && text.front() >= '0' && text.front() <= '9') {  // "1 1/3"
    const std::optional<double> over = take_number(text), under = take_divisor(text);
    if (!over || !under || *under == 0.0) return {};
    seconds += *over / *under;
    skip_blanks(text);
  }
  if (!text.empty() && text != "s" && text != "\"" && text != "sec") return {};
  return seconds > 0.0 ? std::optional(seconds) : std::nullopt;
}

std::optional<double> parse_iso(const std::string& choice) {
  std::string_view text = choice;
  if (text.starts_with("ISO") || text.starts_with("iso")) text.remove_prefix(3);
  skip_blanks(text);
  const std::optional<double> iso = take_number(text);
  if (!iso || *iso == 0.0 || !text.empty()) return {};
  return iso;
}

bool same_choice(double a, double b) {
  return a > 0.0 && b > 0.0 && std::abs(a - b) <= kDialTolerance * std::min(a, b);
}

std::optional<std::string> find_choice(const std::vector<std::string>& choices,
                                       std::optional<double> (*parse)(const std::string&), double wanted) {
  std::optional<std::string> nearest;
  double least = 0.0;
  for (const std::string& choice : choices) {
    const std::optional<double> value = parse(choice);
    if (!value || !same_choice(*value, wanted)) continue;
    const double distance = std::abs(std::log(*value / wanted));
    if (nearest && distance >= least) continue;
    nearest = choice;
    least = distance;
  }
  return nearest;
}

}  // namespace lumitexel
