#include "processing/calibration/import/colmap_text.h"

#include <cmath>
#include <limits>
#include <set>

#include "drivers/error.h"
#include "processing/calibration/import/text_fields.h"

namespace lumitexel {
namespace {

bool is_comment(std::string_view text) { return !text.empty() && text.front() == '#'; }

struct ModelForm {
  std::string_view name;
  std::vector<std::string> parameters;
};

const ModelForm& form_of(std::string_view name, const std::string& place) {
  static const ModelForm kForms[] = {{"PINHOLE", {"fx", "fy", "cx", "cy"}},
                                     {"OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}},
                                     {"SIMPLE_RADIAL", {"f", "cx", "cy", "k"}}};
  for (const ModelForm& form : kForms) {
    if (form.name == name) return form;
  }
  throw BadInput(place + ": MODEL", "'" + std::string(name) + "' is not supported", "PINHOLE, OPENCV or SIMPLE_RADIAL");
}

CameraModel camera_with(std::string_view model, const std::vector<double>& p) {
  CameraModel camera;
  if (model == "SIMPLE_RADIAL") {
    camera.focal_x_px = camera.focal_y_px = p[0];
    camera.principal_x_px = p[1];
    camera.principal_y_px = p[2];
    camera.k1 = p[3];
    return camera;
  }
  camera.focal_x_px = p[0];
  camera.focal_y_px = p[1];
  camera.principal_x_px = p[2];
  camera.principal_y_px = p[3];
  if (model == "OPENCV") {
    camera.k1 = p[4];
    camera.k2 = p[5];
    camera.p1 = p[6];
    camera.p2 = p[7];
  }
  return camera;
}

int size_from(std::string_view field, const std::string& place, const std::string& name) {
  const std::int64_t size = count_from(field, place, name);
  if (size < 1 || size > std::numeric_limits<int>::max()) {
    throw BadInput(place + ": " + name, std::to_string(size) + " pixels", "at least one pixel");
  }
  return static_cast<int>(size);
}

CameraModel camera_from(const std::vector<std::string_view>& fields, const std::string& place) {
  const ModelForm& form = form_of(fields[1], place);
  if (fields.size() != 4 + form.parameters.size()) {
    throw BadInput(place + ": PARAMS[]", std::to_string(fields.size() - 4) + " parameters",
                   std::to_string(form.parameters.size()) + " for " + std::string(form.name));
  }
  std::vector<double> parameters;
  for (std::size_t i = 0; i < form.parameters.size(); ++i) {
    parameters.push_back(number_from(fields[4 + i], place, form.parameters[i]));
  }
  CameraModel camera = camera_with(form.name, parameters);
  camera.width_px = size_from(fields[2], place, "WIDTH");
  camera.height_px = size_from(fields[3], place, "HEIGHT");
  if (camera.focal_x_px <= 0.0 || camera.focal_y_px <= 0.0) {
    throw BadInput(place + ": " + form.parameters[0], "a focal length that is not positive", "pixels, above 0");
  }
  return camera;
}

// The name is the rest of the line and may hold spaces.
std::string name_from(std::string_view line, std::string_view camera_id_field) {
  const auto after = static_cast<std::size_t>(camera_id_field.data() + camera_id_field.size() - line.data());
  return std::string(trimmed(line.substr(after)));
}

PosedImage image_from(const TextLine& line) {
  static const char* const kNames[] = {"IMAGE_ID", "QW", "QX", "QY", "QZ", "TX", "TY", "TZ", "CAMERA_ID", "NAME"};
  const std::vector<std::string_view> fields = split_at_spaces(line.text);
  if (fields.size() < std::size(kNames)) {
    throw BadInput(line.place + ": " + kNames[fields.size()], "missing",
                   "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
  }
  double pose[7];
  for (std::size_t i = 0; i < 7; ++i) pose[i] = number_from(fields[1 + i], line.place, kNames[1 + i]);
  const Eigen::Quaterniond rotation(pose[0], pose[1], pose[2], pose[3]);
  if (std::abs(rotation.norm() - 1.0) > 0.01) {
    throw BadInput(line.place + ": QW QX QY QZ", "a quaternion of length " + std::to_string(rotation.norm()),
                   "length 1");
  }
  count_from(fields[0], line.place, kNames[0]);
  PosedImage image;
  image.name = name_from(line.text, fields[8]);
  image.camera_id = count_from(fields[8], line.place, kNames[8]);
  image.camera_from_world = Eigen::Translation3d(pose[4], pose[5], pose[6]) * rotation.normalized();
  image.place = line.place;
  return image;
}

// The points are not used, but reading them shows a file that leaves their lines out, and so would lose every other
// image.
void check_points_line(const TextLine& line) {
  const std::vector<std::string_view> fields = split_at_spaces(line.text);
  if (fields.size() % 3 != 0 || is_comment(line.text)) {
    throw BadInput(line.place, std::to_string(fields.size()) + " fields where an image's 2-d points belong",
                   "an empty line, or X Y POINT3D_ID for each point");
  }
}

}  // namespace

std::map<std::int64_t, CameraModel> parse_cameras_txt(std::string_view text, const std::string& where) {
  std::map<std::int64_t, CameraModel> cameras;
  for (const TextLine& line : lines_of(text, where)) {
    const std::vector<std::string_view> fields = split_at_spaces(line.text);
    if (fields.empty() || is_comment(fields.front())) continue;
    if (fields.size() < 4)
      throw BadInput(line.place, "a camera of few fields", "CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]");
    const std::int64_t id = count_from(fields[0], line.place, "CAMERA_ID");
    if (!cameras.emplace(id, camera_from(fields, line.place)).second) {
      throw BadInput(line.place + ": CAMERA_ID", std::to_string(id) + " stands twice", "each camera once");
    }
  }
  if (cameras.empty()) throw BadInput(where, "no camera", "at least one");
  return cameras;
}

std::vector<PosedImage> parse_images_txt(std::string_view text, const std::string& where,
                                         const std::map<std::int64_t, CameraModel>& cameras) {
  std::vector<PosedImage> images;
  std::set<std::string> names;
  const std::vector<TextLine> lines = lines_of(text, where);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (trimmed(lines[i].text).empty() || is_comment(lines[i].text)) continue;
    images.push_back(image_from(lines[i]));
    const PosedImage& image = images.back();
    if (!cameras.contains(image.camera_id)) {
      throw BadInput(image.place + ": CAMERA_ID", "no camera " + std::to_string(image.camera_id), "one of cameras.txt");
    }
    if (!names.insert(image.name).second) {
      throw BadInput(image.place + ": NAME", image.name + " stands twice", "each image once");
    }
    if (++i < lines.size()) check_points_line(lines[i]);
  }
  if (images.empty()) throw BadInput(where, "no image", "at least one");
  return images;
}

}  // namespace lumitexel
