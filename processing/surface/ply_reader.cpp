#include "processing/surface/ply_reader.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "processing/surface/wedge_texcoords.h"

namespace lumitexel {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read by copying");

enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
  std::string name;
  Scalar type = Scalar::Float32;
  std::optional<Scalar> count_type;  // set for a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool binary = false;
  std::vector<Element> elements;
  std::size_t bytes = 0, lines = 0;
};

std::optional<Scalar> scalar_from(const std::string& name) {
  static const std::pair<const char*, Scalar> kNames[] = {
      {"char", Scalar::Int8},      {"int8", Scalar::Int8},       {"uchar", Scalar::Uint8},
      {"uint8", Scalar::Uint8},    {"short", Scalar::Int16},     {"int16", Scalar::Int16},
      {"ushort", Scalar::Uint16},  {"uint16", Scalar::Uint16},   {"int", Scalar::Int32},
      {"int32", Scalar::Int32},    {"uint", Scalar::Uint32},     {"uint32", Scalar::Uint32},
      {"float", Scalar::Float32},  {"float32", Scalar::Float32}, {"double", Scalar::Float64},
      {"float64", Scalar::Float64}};
  for (const auto& [known, type] : kNames) {
    if (name == known) return type;
  }
  return std::nullopt;
}

Property property_from(std::istringstream& words, const std::string& at) {
  std::string type, count_type, name;
  words >> type;
  const bool list = type == "list";
  if (list) words >> count_type >> type;
  words >> name;
  const auto scalar = scalar_from(type), count = scalar_from(count_type);
  if (!scalar || (list && !count) || name.empty()) {
    throw BadInput(at, "an unreadable property", "property TYPE NAME or property list TYPE TYPE NAME");
  }
  return {name, *scalar, count};
}

void read_header_line(const std::string& line, const std::string& at, Header& header) {
  std::istringstream words(line);
  std::string keyword, word;
  words >> keyword;
  if (keyword == "format") {
    words >> word;
    header.binary = word == "binary_little_endian";
    if (!header.binary && word != "ascii") throw BadInput(at, "format " + word, "ascii or binary_little_endian");
  } else if (keyword == "element") {
    Element element;
    if (!(words >> element.name >> element.count)) throw BadInput(at, "an unreadable element", "element NAME COUNT");
    header.elements.push_back(element);
  } else if (keyword == "property") {
    if (header.elements.empty()) throw BadInput(at, "a property before any element", "an element first");
    header.elements.back().properties.push_back(property_from(words, at));
  } else if (keyword != "comment" && keyword != "obj_info" && keyword != "ply" && !keyword.empty()) {
    throw BadInput(at, "unknown keyword " + keyword, "a PLY header");
  }
}

Header read_header(std::string_view bytes, const std::string& where) {
  if (bytes.substr(0, 3) != "ply") throw BadInput(where, "no PLY file", "the first line to be ply");
  Header header;
  bool has_format = false;
  while (true) {
    const std::size_t end = bytes.find('\n', header.bytes);
    if (end == std::string_view::npos) throw BadInput(where, "the header ends early", "end_header");
    std::string line(bytes.substr(header.bytes, end - header.bytes));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    header.bytes = end + 1;
    ++header.lines;
    if (line == "end_header") break;
    has_format = has_format || line.rfind("format ", 0) == 0;
    read_header_line(line, where + ":" + std::to_string(header.lines), header);
  }
  if (!has_format) throw BadInput(where, "a header without a format", "format ascii 1.0 or binary_little_endian 1.0");
  return header;
}

template <typename T>
double load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return static_cast<double>(value);
}

// The body as a row of numbers, whichever way they are written.
class Body {
 public:
  Body(std::string_view bytes, const Header& header, const std::string& where)
      : at_(bytes.data() + header.bytes),
        end_(bytes.data() + bytes.size()),
        binary_(header.binary),
        line_(header.lines + 1),
        where_(where) {}

  void enter(const Element& element, std::size_t index) { element_ = &element, index_ = index; }
  double next(Scalar type) { return binary_ ? next_binary(type) : next_text(); }
  // Where the next text value stands.
  std::size_t line() {
    skip_space();
    return line_;
  }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  std::string place() const {
    return where_ + (binary_ ? "" : ":" + std::to_string(line_)) + ": " + element_->name + " " + std::to_string(index_);
  }

 private:
  void skip_space() {
    for (; at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n'); ++at_) line_ += *at_ == '\n';
  }

  double next_text() {
    skip_space();
    double value = 0;
    const char* start = at_ < end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [stop, failure] = std::from_chars(start, end_, value);
    const bool whole = stop == end_ || *stop == ' ' || *stop == '\t' || *stop == '\r' || *stop == '\n';
    if (failure != std::errc() || !whole) {
      throw BadInput(place(), at_ == end_ ? "the file ends early" : "an unreadable value", "a number");
    }
    at_ = stop;
    return value;
  }

  double next_binary(Scalar type) {
    static constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t size = kBytes[static_cast<std::size_t>(type)];
    if (bytes_left() < size) throw BadInput(place(), "the file ends early", "as many values as the header says");
    const char* from = at_;
    at_ += size;
    switch (type) {
      case Scalar::Int8:
        return load<std::int8_t>(from);
      case Scalar::Uint8:
        return load<std::uint8_t>(from);
      case Scalar::Int16:
        return load<std::int16_t>(from);
      case Scalar::Uint16:
        return load<std::uint16_t>(from);
      case Scalar::Int32:
        return load<std::int32_t>(from);
      case Scalar::Uint32:
        return load<std::uint32_t>(from);
      case Scalar::Float32:
        return load<float>(from);
      case Scalar::Float64:
        return load<double>(from);
    }
    return 0;
  }

  const char* at_;
  const char* end_;
  bool binary_;
  std::size_t line_;
  std::string where_;
  const Element* element_ = nullptr;
  std::size_t index_ = 0;
};

// Which of a vertex's eight numbers a property is: x y z nx ny nz s t; -1 for others.
int slot_of(const Property& property) {
  static const std::vector<const char*> kNames[] = {{"x"},  {"y"},  {"z"},  {"nx"},
                                                    {"ny"}, {"nz"}, {"s", "u", "texture_u"}, {"t", "v", "texture_v"}};
  for (int slot = 0; slot < 8; ++slot) {
    for (const char* name : kNames[slot]) {
      if (!property.count_type && property.name == name) return slot;
    }
  }
  return -1;
}

void skip(Body& body, const Property& property) {
  const double count = property.count_type ? body.next(*property.count_type) : 1.0;
  for (double i = 0; i < count; ++i) body.next(property.type);
}

void read_vertices(Body& body, const Element& element, bool text, ParsedMesh& parsed, const std::string& where) {
  std::vector<int> slots;
  std::array<bool, 8> has{};
  for (const Property& property : element.properties) {
    slots.push_back(slot_of(property));
    if (slots.back() >= 0) has[static_cast<std::size_t>(slots.back())] = true;
  }
  if (!has[0] || !has[1] || !has[2]) throw BadInput(where + ": element vertex", "no x, y or z", "all three");
  const bool normals = has[3] && has[4] && has[5], texcoords = has[6] && has[7];
  std::array<double, 8> value{};
  for (std::size_t i = 0; i < element.count; ++i) {
    body.enter(element, i);
    if (text) parsed.line_of_position.push_back(body.line());
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (slots[p] < 0) {
        skip(body, element.properties[p]);
      } else {
        value[static_cast<std::size_t>(slots[p])] = body.next(element.properties[p].type);
      }
    }
    parsed.mesh.positions.emplace_back(value[0], value[1], value[2]);
    if (normals) parsed.mesh.normals.emplace_back(value[3], value[4], value[5]);
    if (texcoords) parsed.mesh.texcoords.emplace_back(value[6], value[7]);
  }
}

std::uint32_t vertex_index(Body& body, Scalar type) {
  const double value = body.next(type);
  if (!(value >= 0.0 && value < 4294967295.0 && value == std::floor(value))) {
    throw BadInput(body.place(), "vertex index " + std::to_string(value), "a whole number from 0");
  }
  return static_cast<std::uint32_t>(value);
}

struct Polygon {
  std::vector<std::uint32_t> corners;
  std::vector<double> texcoords;  // two a corner; none where the file gives none
};

void read_corners(Body& body, const Property& list, Polygon& polygon) {
  const double count = body.next(*list.count_type);
  if (!(count >= 3.0)) throw BadInput(body.place(), "a face of " + std::to_string(count) + " corners", "three or more");
  for (double i = 0; i < count; ++i) polygon.corners.push_back(vertex_index(body, list.type));
}

void read_texcoords(Body& body, const Property& list, Polygon& polygon) {
  const double count = body.next(*list.count_type);
  for (double i = 0; i < count; ++i) polygon.texcoords.push_back(body.next(list.type));
}

// As a fan; wedges get the corners' texture coordinates, NaN where the face has none.
void add_polygon(const Polygon& polygon, std::uint32_t face, const std::string& place, ParsedMesh& parsed, WedgeTexcoords& wedges) {
  if (!polygon.texcoords.empty() && polygon.texcoords.size() != 2 * polygon.corners.size()) {
    throw BadInput(place, std::to_string(polygon.texcoords.size()) + " numbers in texcoord",
                   std::to_string(2 * polygon.corners.size()) + ", two a corner");
  }
  const auto texcoord = [&](std::size_t corner) -> Eigen::Vector2d {
    if (polygon.texcoords.empty()) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    return {polygon.texcoords[2 * corner], polygon.texcoords[2 * corner + 1]};
  };
  for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
    parsed.mesh.triangles.push_back({polygon.corners[0], polygon.corners[i - 1], polygon.corners[i]});
    parsed.face_of_triangle.push_back(face);
    wedges.push_back({texcoord(0), texcoord(i - 1), texcoord(i)});
  }
}

void read_faces(Body& body, const Element& element, bool text, ParsedMesh& parsed, WedgeTexcoords& wedges, const std::string& where) {
  const auto is_corners = [](const Property& p) {
    return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  bool found = false;
  for (const Property& property : element.properties) found = found || is_corners(property);
  if (!found) throw BadInput(where + ": element face", "no list of corners", "property list … vertex_indices");
  parsed.mesh.triangles.reserve(element.count);
  parsed.face_of_triangle.reserve(element.count);
  for (std::size_t i = 0; i < element.count; ++i) {
    body.enter(element, i);
    if (text) parsed.line_of_face.push_back(body.line());
    Polygon polygon;
    for (const Property& property : element.properties) {
      if (is_corners(property)) {
        read_corners(body, property, polygon);
      } else if (property.count_type && property.name == "texcoord") {
        read_texcoords(body, property, polygon);
      } else {
        skip(body, property);
      }
    }
    add_polygon(polygon, static_cast<std::uint32_t>(i), body.place(), parsed, wedges);
  }
}

}  // namespace

ParsedMesh parse_ply(std::string_view bytes, const std::string& where) {
  const Header header = read_header(bytes, where);
  Body body(bytes, header, where);
  ParsedMesh parsed;
  WedgeTexcoords wedges;
  for (const Element& element : header.elements) {
    // Every value takes a byte at least; asked first, so that a damaged count does not allocate what it claims.
    if (element.count > body.bytes_left()) {
      throw BadInput(where + ": element " + element.name, "the file ends early",
                     std::to_string(element.count) + " of them");
    }
    if (element.name == "vertex") {
      read_vertices(body, element, !header.binary, parsed, where);
    } else if (element.name == "face") {
      read_faces(body, element, !header.binary, parsed, wedges, where);
    } else {
      for (std::size_t i = 0; i < element.count; ++i) {
        body.enter(element, i);
        for (const Property& property : element.properties) skip(body, property);
      }
    }
  }
  if (parsed.mesh.texcoords.empty()) split_wedges(wedges, parsed);
  return parsed;
}

}  // namespace lumitexel
