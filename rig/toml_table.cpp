#include "rig/toml_table.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "drivers/error.h"

namespace lumitexel {

struct TomlTable::Node {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table = nullptr;
  std::shared_ptr<const std::string> text;
  std::string where, path;  // path: "" or "camera."
  std::set<std::string> read;

  std::string place(const std::string& key, const toml::node* node) const {
    const auto line = (node != nullptr ? node : table)->source().begin.line;
    return where + ":" + std::to_string(std::max<unsigned>(line, 1)) + ": " + path + key;
  }
  const toml::node& require(const std::string& key, const std::string& expected) {
    read.insert(key);
    const toml::node* found = table->get(key);
    if (found == nullptr) throw BadInput(place(key, nullptr), "missing", expected);
    return *found;
  }
  std::shared_ptr<Node> child(const toml::table& inner, const std::string& name) const {
    auto node = std::make_shared<Node>(*this);
    node->table = &inner;
    node->path = path + name + ".";
    node->read.clear();
    return node;
  }
};

namespace {

std::string shown(const toml::node& node) {
  constexpr std::size_t kLongest = 60;
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string one_line = text.str();
  std::replace(one_line.begin(), one_line.end(), '\n', ' ');
  return one_line.size() <= kLongest ? one_line : one_line.substr(0, kLongest) + "...";
}

bool allowed(double value, const NumberRange& range) {
  return std::isfinite(value) && value >= range.min && value <= range.max && !(range.min_excluded && value == range.min);
}

// An integer counts as a number, a boolean or a string does not.
const toml::node* first_bad_number(const toml::array& array, const NumberRange& range) {
  for (const toml::node& element : array) {
    if (!element.is_number() || !allowed(*element.value<double>(), range)) return &element;
  }
  return nullptr;
}

// Which lines begin something, and whether it lies inside the table looked for.
void collect_lines(const toml::node& node, bool inside, std::map<unsigned, bool>& begins) {
  begins[node.source().begin.line] = inside;
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      begins[key.source().begin.line] = inside;
      collect_lines(value, inside, begins);
    }
  } else if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) collect_lines(element, inside, begins);
  }
}

}  // namespace

NumberRange NumberRange::between(double min, double max) {
  std::ostringstream text;
  text << "a number from " << min << " to " << max;
  return {min, max, false, text.str()};
}

TomlTable TomlTable::parse(const std::string& text, const std::string& where) {
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(text, where));
    auto node = std::make_shared<Node>();
    node->root = root;
    node->table = root.get();
    node->text = std::make_shared<const std::string>(text);
    node->where = where;
    return TomlTable(std::move(node));
  } catch (const toml::parse_error& error) {
    throw BadInput(where + ":" + std::to_string(error.source().begin.line), std::string(error.description()),
                   "valid TOML");
  }
}

bool TomlTable::has(const std::string& key) const { return node_->table->contains(key); }

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *node_->table) keys.emplace_back(key.str());
  return keys;
}

double TomlTable::number(const std::string& key, const NumberRange& range) const {
  const toml::node& found = node_->require(key, range.text);
  if (!found.is_number() || !allowed(*found.value<double>(), range)) reject(key, shown(found), range.text);
  return *found.value<double>();
}

int TomlTable::integer(const std::string& key, int min, int max) const {
  const std::string expected = "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  const toml::node& found = node_->require(key, expected);
  const toml::value<std::int64_t>* value = found.as_integer();
  if (value == nullptr || value->get() < min || value->get() > max) reject(key, shown(found), expected);
  return static_cast<int>(value->get());
}

std::string TomlTable::string(const std::string& key) const {
  const std::string expected = "a string that is not empty";
  const toml::node& found = node_->require(key, expected);
  const toml::value<std::string>* value = found.as_string();
  if (value == nullptr || value->get().empty()) reject(key, shown(found), expected);
  return value->get();
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count, const NumberRange& range) const {
  const std::string expected = "an array of " + (count == 0 ? "at least one" : std::to_string(count)) + ", each " + range.text;
  const toml::node& found = node_->require(key, expected);
  const toml::array* array = found.as_array();
  if (array == nullptr) reject(key, shown(found), expected);
  if (count == 0 ? array->empty() : array->size() != count) {
    reject(key, std::to_string(array->size()) + " values", expected);
  }
  if (const toml::node* bad = first_bad_number(*array, range)) {
    throw BadInput(node_->place(key, bad), shown(*bad), expected);
  }
  std::vector<double> values;
  for (const toml::node& element : *array) values.push_back(*element.value<double>());
  return values;
}

TomlTable TomlTable::table(const std::string& key) const {
  const toml::node& found = node_->require(key, "a table");
  if (!found.is_table()) reject(key, shown(found), "a table");
  return TomlTable(node_->child(*found.as_table(), key));
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  const std::string expected = "an array of at least one table";
  const toml::node& found = node_->require(key, expected);
  const toml::array* array = found.as_array();
  if (array == nullptr || array->empty()) reject(key, shown(found), expected);
  std::vector<TomlTable> result;
  for (const toml::node& element : *array) {
    if (!element.is_table()) throw BadInput(node_->place(key, &element), shown(element), "a table");
    result.push_back(TomlTable(node_->child(*element.as_table(), key + "[" + std::to_string(result.size()) + "]")));
  }
  return result;
}

std::string TomlTable::text_of(const std::string& key) const {
  node_->require(key, "a table");
  std::map<unsigned, bool> begins{{0, false}};
  for (const auto& [name, value] : *node_->root) {
    const bool inside = node_->table == node_->root.get() && name.str() == key;
    begins[name.source().begin.line] = inside;
    collect_lines(value, inside, begins);
  }
  std::istringstream lines(*node_->text);
  std::string line, text;
  for (unsigned number = 1; std::getline(lines, line); ++number) {
    if (std::prev(begins.upper_bound(number))->second) text += line;
    text += '\n';
  }
  return text;
}

void TomlTable::reject(const std::string& key, const std::string& what, const std::string& expected) const {
  throw BadInput(node_->place(key, node_->table->get(key)), what, expected);
}

void TomlTable::reject_unread() const {
  for (const auto& [key, value] : *node_->table) {
    const std::string name(key.str());
    if (node_->read.contains(name)) continue;
    std::string known;
    for (const std::string& read : node_->read) known += (known.empty() ? "" : ", ") + read;
    throw BadInput(node_->place(name, &value), "unknown key", "one of " + known);
  }
}

}  // namespace lumitexel
