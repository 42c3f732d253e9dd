#include "processing/surface/obj_reader.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

struct Corner {
  std::uint32_t v = kNone, vt = kNone, vn = kNone;
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    // Odd constants spread neighbouring indices; any would do.
    return corner.v * 0x9e3779b97f4a7c15u ^ corner.vt * 0xc2b2ae3d27d4eb4fu ^ corner.vn * 0x165667b19e3779f9u;
  }
};

// The words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line.substr(0, line.find('#'))) {}

  std::string_view next() {
    const std::size_t start = rest_.find_first_not_of(" \t\r");
    if (start == std::string_view::npos) return {};
    const std::size_t end = std::min(rest_.find_first_of(" \t\r", start), rest_.size());
    const std::string_view word = rest_.substr(start, end - start);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

class ObjReader {
 public:
  explicit ObjReader(const std::string& where) : where_(where) {}

  void read_line(std::string_view text) {
    ++line_;
    Words words(text);
    const std::string_view keyword = words.next();
    if (keyword == "v") {
      positions_.push_back(vector<3>(words));
      parsed_.line_of_position.push_back(line_);
    } else if (keyword == "vt") {
      texcoords_.push_back(vector<2>(words));
    } else if (keyword == "vn") {
      normals_.push_back(vector<3>(words));
    } else if (keyword == "f") {
      read_face(words);
    }
  }

  ParsedMesh take() {
    // A map with holes is of no use to anyone who samples it.
    if (corners_without_texcoord_ > 0) parsed_.mesh.texcoords.clear();
    return std::move(parsed_);
  }

 private:
  std::string place() const { return where_ + ":" + std::to_string(line_); }

  template <int N>
  Eigen::Matrix<double, N, 1> vector(Words& words) {
    Eigen::Matrix<double, N, 1> result;
    for (int i = 0; i < N; ++i) {
      std::string_view word = words.next();
      if (!word.empty() && word.front() == '+') word.remove_prefix(1);
      const auto [stop, failure] = std::from_chars(word.data(), word.data() + word.size(), result[i]);
      if (failure != std::errc() || stop != word.data() + word.size() || !std::isfinite(result[i])) {
        throw BadInput(place(), "coordinate '" + std::string(word) + "'", std::to_string(N) + " finite numbers");
      }
    }
    return result;
  }

  // From 1, or from -1 for the last one read so far.
  std::uint32_t index(std::string_view word, std::size_t count, const char* what) const {
    long long value = 0;
    const auto [stop, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    const long long from_zero = value < 0 ? static_cast<long long>(count) + value : value - 1;
    if (failure != std::errc() || stop != word.data() + word.size() || from_zero < 0 ||
        from_zero >= static_cast<long long>(count)) {
      throw BadInput(place(), std::string("face with ") + what + " index '" + std::string(word) + "'",
                     "1 to " + std::to_string(count) + ", or negative from the end");
    }
    return static_cast<std::uint32_t>(from_zero);
  }

  Corner corner_from(std::string_view word) const {
    const std::size_t first = word.find('/');
    Corner corner;
    corner.v = index(word.substr(0, first), positions_.size(), "vertex");
    if (first == std::string_view::npos) return corner;
    const std::size_t second = word.find('/', first + 1);
    const std::string_view vt = word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
    if (!vt.empty()) corner.vt = index(vt, texcoords_.size(), "texture");
    if (second != std::string_view::npos) corner.vn = index(word.substr(second + 1), normals_.size(), "normal");
    return corner;
  }

  std::uint32_t vertex_of(const Corner& corner) {
    const auto [it, added] = vertices_.try_emplace(corner, static_cast<std::uint32_t>(parsed_.mesh.positions.size()));
    if (!added) return it->second;
    Mesh& mesh = parsed_.mesh;
    mesh.positions.push_back(positions_[corner.v]);
    mesh.normals.push_back(corner.vn == kNone ? Eigen::Vector3d::Zero() : normals_[corner.vn]);
    mesh.texcoords.push_back(corner.vt == kNone ? Eigen::Vector2d::Zero() : texcoords_[corner.vt]);
    corners_without_texcoord_ += corner.vt == kNone;
    parsed_.position_of_vertex.push_back(corner.v);
    return it->second;
  }

  void read_face(Words& words) {
    std::vector<std::uint32_t> polygon;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      polygon.push_back(vertex_of(corner_from(word)));
    }
    if (polygon.size() < 3) {
      throw BadInput(place(), "a face of " + std::to_string(polygon.size()) + " corners", "three or more");
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      parsed_.mesh.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
      parsed_.face_of_triangle.push_back(static_cast<std::uint32_t>(parsed_.line_of_face.size()));
    }
    parsed_.line_of_face.push_back(line_);
  }

  std::string where_;
  std::size_t line_ = 0;
  std::vector<Eigen::Vector3d> positions_, normals_;
  std::vector<Eigen::Vector2d> texcoords_;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
  std::size_t corners_without_texcoord_ = 0;
  ParsedMesh parsed_;
};

}  // namespace

ParsedMesh parse_obj(std::string_view bytes, const std::string& where) {
  ObjReader reader(where);
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    reader.read_line(bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  return reader.take();
}

}  // namespace lumitexel
