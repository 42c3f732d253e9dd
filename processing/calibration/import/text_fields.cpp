#include "processing/calibration/import/text_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::string_view kSpaces = " \t\r";

}  // namespace

std::vector<TextLine> lines_of(std::string_view text, const std::string& where) {
  std::vector<TextLine> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back({text.substr(0, end), where + ":" + std::to_string(lines.size() + 1)});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t start = text.find_first_not_of(kSpaces);
  if (start == std::string_view::npos) return {};
  return text.substr(start, text.find_last_not_of(kSpaces) - start + 1);
}

std::vector<std::string_view> split_at(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = text.find(separator);
    fields.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> split_at_spaces(std::string_view text) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t start = text.find_first_not_of(kSpaces);
    if (start == std::string_view::npos) return fields;
    const std::size_t end = std::min(text.find_first_of(kSpaces, start), text.size());
    fields.push_back(text.substr(start, end - start));
    text.remove_prefix(end);
  }
}

double number_from(std::string_view field, const std::string& place, const std::string& name) {
  const std::string_view digits = !field.empty() && field.front() == '+' ? field.substr(1) : field;
  double value = 0;
  const auto [stop, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)) {
    throw BadInput(place + ": " + name, "'" + std::string(field) + "' is no finite number", "a finite number");
  }
  return value;
}

std::int64_t count_from(std::string_view field, const std::string& place, const std::string& name) {
  std::int64_t value = 0;
  const auto [stop, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (failure != std::errc() || stop != field.data() + field.size() || value < 0) {
    throw BadInput(place + ": " + name, "'" + std::string(field) + "' is no whole number", "a whole number from 0");
  }
  return value;
}

}  // namespace lumitexel
