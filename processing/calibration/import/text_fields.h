// Lines and fields of text files, with errors that name file, line and field.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumitexel {

struct TextLine {
  std::string_view text;  // without the line's end
  std::string place;      // "FILE:LINE", for errors
};

// All lines, blank ones and comments too. The text must outlive them.
std::vector<TextLine> lines_of(std::string_view text, const std::string& where);

std::string_view trimmed(std::string_view text);
std::vector<std::string_view> split_at(std::string_view text, char separator);  // fields trimmed; "" gives one
std::vector<std::string_view> split_at_spaces(std::string_view text);

// The whole field as a finite number. Throws BadInput "FILE:LINE: FIELD: '…' is no finite number".
double number_from(std::string_view field, const std::string& place, const std::string& name);
// As a whole number >= 0.
std::int64_t count_from(std::string_view field, const std::string& place, const std::string& name);

}  // namespace lumitexel
