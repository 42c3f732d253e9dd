// An option's value that is one of a few words.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "drivers/error.h"

namespace lumitexel {

// "lafortune, ggx or ward"
template <typename Value>
std::string words_of(const std::vector<std::pair<std::string, Value>>& known) {
  std::string text;
  for (std::size_t i = 0; i < known.size(); ++i) text += (i == 0 ? "" : i + 1 == known.size() ? " or " : ", ") + known[i].first;
  return text;
}

// The value that `word` stands for. Throws BadInput naming the option, the word, and the words that there are.
template <typename Value>
Value named_value(const std::string& option, const std::string& word, const std::vector<std::pair<std::string, Value>>& known) {
  for (const auto& [name, value] : known) {
    if (word == name) return value;
  }
  throw BadInput(option, "'" + word + "'", words_of(known));
}

// Words for what to_string names.
template <typename Values>
auto words_by_to_string(const Values& values) {
  std::vector<std::pair<std::string, std::decay_t<decltype(*std::begin(values))>>> known;
  for (const auto& value : values) known.emplace_back(to_string(value), value);
  return known;
}

}  // namespace lumitexel
