#include "processing/calibration/import/import_layout.h"

#include <algorithm>
#include <map>

#include "drivers/error.h"
#include "processing/calibration/import/colmap_text.h"
#include "processing/calibration/import/lights_csv.h"

namespace lumitexel {

std::vector<View> join_views(const NamedText& cameras_txt, const NamedText& images_txt, const NamedText& lights_csv) {
  const auto cameras = parse_cameras_txt(cameras_txt.text, cameras_txt.where);
  const std::vector<PosedImage> images = parse_images_txt(images_txt.text, images_txt.where, cameras);
  std::map<std::string, LightRow> lights;
  for (LightRow& row : parse_lights_csv(lights_csv.text, lights_csv.where)) lights.emplace(row.image, std::move(row));

  std::vector<View> views;
  for (const PosedImage& image : images) {
    const auto light = lights.find(image.name);
    if (light == lights.end()) {
      throw BadInput(lights_csv.where + ": image", "no row for " + image.name, "one for each image of images.txt");
    }
    View view;
    view.name = image.name;
    view.heldout = light->second.heldout;
    view.camera = cameras.at(image.camera_id);
    view.camera_from_world = image.camera_from_world;
    view.light = light->second.light;
    views.push_back(std::move(view));
    lights.erase(light);
  }
  if (!lights.empty()) {
    throw BadInput(lights.begin()->second.place + ": image", lights.begin()->first + " is not in images.txt",
                   "an image with a pose");
  }
  if (std::all_of(views.begin(), views.end(), [](const View& view) { return view.heldout; })) {
    throw BadInput(lights_csv.where + ": split", "every image is held out", "at least one to fit");
  }
  return views;
}

void reduce_intensity(Light& light, int channels) {
  if (channels == 3) return;
  light.intensity = {(light.intensity[0] + light.intensity[1] + light.intensity[2]) / 3.0};
}

bool has_in_sight(const View& view, const Mesh& mesh) {
  return std::any_of(mesh.positions.begin(), mesh.positions.end(), [&](const Eigen::Vector3d& x_in_world) {
    const Eigen::Vector3d x_in_camera = view.camera_from_world * x_in_world;
    return x_in_camera.z() > 0.0 && view.camera.contains(view.camera.project(x_in_camera));
  });
}

}  // namespace lumitexel
