#include "processing/calibration/import/lights_csv.h"

#include <cmath>
#include <map>
#include <set>

#include "drivers/error.h"
#include "processing/calibration/import/text_fields.h"

namespace lumitexel {
namespace {

const char* const kRequired[] = {"image", "type", "x", "y", "z", "intensity_r", "intensity_g", "intensity_b"};
constexpr const char* kSplit = "split";
constexpr double kUnitTolerance = 0.01;

using Columns = std::map<std::string, std::size_t, std::less<>>;

Columns columns_from(const TextLine& header) {
  const std::set<std::string, std::less<>> known = [] {
    std::set<std::string, std::less<>> names(std::begin(kRequired), std::end(kRequired));
    names.insert(kSplit);
    return names;
  }();
  Columns columns;
  std::string unknown;
  const std::vector<std::string_view> fields = split_at(header.text, ',');
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name(fields[i]);
    if (!known.contains(name)) unknown += (unknown.empty() ? "'" : ", '") + name + "'";
    if (!columns.emplace(name, i).second)
      throw BadInput(header.place + ": " + name, "a column twice", "each column once");
  }
  if (!unknown.empty()) {
    throw BadInput(header.place, "unknown column " + unknown,
                   "image,type,x,y,z,intensity_r,intensity_g,intensity_b and possibly split");
  }
  for (const char* name : kRequired) {
    if (!columns.contains(name)) throw BadInput(header.place + ": " + name, "no such column", "one of that name");
  }
  return columns;
}

Light::Type type_from(std::string_view text, const std::string& place) {
  if (text == "point") return Light::Type::Point;
  if (text == "directional") return Light::Type::Directional;
  throw BadInput(place + ": type", "'" + std::string(text) + "'", "point or directional");
}

LightRow row_from(const TextLine& line, const Columns& columns) {
  const std::vector<std::string_view> fields = split_at(line.text, ',');
  if (fields.size() != columns.size()) {
    throw BadInput(line.place, std::to_string(fields.size()) + " fields",
                   std::to_string(columns.size()) + ", as in the header");
  }
  const auto field = [&](const char* name) { return fields[columns.find(name)->second]; };
  const auto number = [&](const char* name) { return number_from(field(name), line.place, name); };

  LightRow row;
  row.place = line.place;
  row.image = field("image");
  if (row.image.empty()) throw BadInput(line.place + ": image", "no name", "an image of images.txt");
  row.light.type = type_from(field("type"), line.place);
  row.light.vector_in_world = {number("x"), number("y"), number("z")};
  if (row.light.type == Light::Type::Directional) {
    const double length = row.light.vector_in_world.norm();
    if (std::abs(length - 1.0) > kUnitTolerance) {
      throw BadInput(line.place + ": x, y, z", "a direction of length " + std::to_string(length), "a unit vector");
    }
    row.light.vector_in_world /= length;
  }
  for (const char* name : {"intensity_r", "intensity_g", "intensity_b"}) {
    row.light.intensity.push_back(number(name));
    if (row.light.intensity.back() <= 0.0) {
      throw BadInput(line.place + ": " + name, "'" + std::string(field(name)) + "'", "a number above 0");
    }
  }
  if (columns.contains(kSplit)) {
    const std::string_view split = field(kSplit);
    if (split != "fit" && split != "heldout") {
      throw BadInput(line.place + ": split", "'" + std::string(split) + "'", "fit or heldout");
    }
    row.heldout = split == "heldout";
  }
  return row;
}

}  // namespace

std::vector<LightRow> parse_lights_csv(std::string_view text, const std::string& where) {
  std::vector<LightRow> rows;
  Columns columns;
  std::set<std::string> images;
  for (const TextLine& line : lines_of(text, where)) {
    if (trimmed(line.text).empty() || line.text.front() == '#') continue;
    if (columns.empty()) {
      columns = columns_from(line);
      continue;
    }
    rows.push_back(row_from(line, columns));
    if (!images.insert(rows.back().image).second) {
      throw BadInput(line.place + ": image", rows.back().image + " stands twice", "each image once");
    }
  }
  if (rows.empty()) throw BadInput(where, "no light", "a header and a row for each image");
  return rows;
}

}  // namespace lumitexel
