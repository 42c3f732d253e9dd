// Typed reading of a TOML table in which every mistake is one clear line: file, line, key, what was found and what was
// expected. A key that nobody asked for is a mistake too: it is most often a misspelt one.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace lumitexel {

// Which numbers a key takes. Infinities and NaN never pass.
struct NumberRange {
  double min = -std::numeric_limits<double>::max(), max = std::numeric_limits<double>::max();
  bool min_excluded = false;
  std::string text = "a finite number";

  static NumberRange finite() { return {}; }
  static NumberRange positive() { return {0.0, std::numeric_limits<double>::max(), true, "a positive number"}; }
  static NumberRange non_negative() { return {0.0, std::numeric_limits<double>::max(), false, "a number >= 0"}; }
  static NumberRange between(double min, double max);  // both ends allowed
};

// Every reader throws BadInput for a missing key, a wrong type or a value out of range.
class TomlTable {
 public:
  // `where` names the source in errors, for example the file's path.
  static TomlTable parse(const std::string& text, const std::string& where);

  bool has(const std::string& key) const;
  std::vector<std::string> keys() const;  // in alphabetical order; does not count them as read
  double number(const std::string& key, const NumberRange& range) const;
  int integer(const std::string& key, int min, int max) const;
  std::string string(const std::string& key) const;  // never empty
  // Exactly `count` numbers, or at least one if count is 0.
  std::vector<double> numbers(const std::string& key, std::size_t count, const NumberRange& range) const;
  TomlTable table(const std::string& key) const;
  std::vector<TomlTable> tables(const std::string& key) const;  // an array of tables, at least one
  // The text of the file with every line blank that does not belong to the table `key` (its header included), so that
  // another reader's errors have the right line. Counts the whole table as read.
  std::string text_of(const std::string& key) const;

  // For checks that involve several keys: throws BadInput at this key's line.
  [[noreturn]] void reject(const std::string& key, const std::string& what, const std::string& expected) const;
  // Throws BadInput for the first key that none of the calls above has asked for. Not recursive.
  void reject_unread() const;

 private:
  struct Node;
  explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

}  // namespace lumitexel
