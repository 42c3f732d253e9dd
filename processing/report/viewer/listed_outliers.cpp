#include "processing/report/viewer/listed_outliers.h"

#include <charconv>
#include <sstream>
#include <vector>

#include "drivers/error.h"

namespace lumitexel {
namespace {

// The first field in quotes, in which "" stands for one; then the others between commas.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  std::size_t at = 1;
  for (; at < line.size(); ++at) {
    if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"')) break;
    if (line[at] == '"') ++at;
    fields[0] += line[at];
  }
  std::istringstream rest(line.substr(std::min(line.size(), at + 2)));
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  return fields;
}

Corrupt unreadable(const std::string& line) { return Corrupt("outliers.csv: '" + line + "' is no line of it"); }

std::uint32_t number(const std::string& field, const std::string& line) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) throw unreadable(line);
  return value;
}

OutlierReason reason_of(const std::string& field, const std::string& line) {
  for (const OutlierReason reason : kOutlierReasons) {
    if (field == to_string(reason)) return reason;
  }
  throw unreadable(line);
}

}  // namespace

std::map<std::pair<std::string, std::uint32_t>, OutlierReason> listed_outliers(const std::string& csv, int atlas_width) {
  std::map<std::pair<std::string, std::uint32_t>, OutlierReason> listed;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);  // how many are listed, and the names of the columns; of models written before the first was, the names alone
  if (line.starts_with('#')) std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = fields_of(line);
    if (line.front() != '"' || fields.size() != 7) throw unreadable(line);
    const std::uint32_t texel = number(fields[2], line) * static_cast<std::uint32_t>(atlas_width) + number(fields[1], line);
    listed[{fields[0], texel}] = reason_of(fields[3], line);
  }
  return listed;
}

}  // namespace lumitexel
