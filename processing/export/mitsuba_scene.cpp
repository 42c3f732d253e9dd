#include "processing/export/mitsuba_scene.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "processing/export/loss_json.h"
#include "processing/export/obj_file.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

std::string texture(const std::string& margin, const std::string& name, const std::string& file, bool raw) {
  return margin + "<texture type=\"bitmap\" name=\"" + name + "\">\n" +                                            //
         margin + "  <string name=\"filename\" value=\"" + file + "\"/>\n" +                                       //
         margin + "  <string name=\"wrap_mode\" value=\"clamp\"/>\n" +                                             //
         margin + "  <boolean name=\"raw\" value=\"" + (raw ? "true" : "false") + "\"/>\n" + margin + "</texture>\n";
}

// The blend takes its parts in the order of their names.
std::string blend(const std::string& margin) {
  return margin + "<bsdf type=\"blendbsdf\" name=\"bsdf\">\n" + texture(margin + "  ", "weight", "weight.png", true) +  //
         margin + "  <bsdf type=\"diffuse\" name=\"bsdf_0\">\n" + texture(margin + "    ", "reflectance", "base.png", false) +
         margin + "  </bsdf>\n" +                                                //
         margin + "  <bsdf type=\"roughconductor\" name=\"bsdf_1\">\n" +         //
         margin + "    <string name=\"material\" value=\"none\"/>\n" +           //
         margin + "    <string name=\"distribution\" value=\"ggx\"/>\n" + texture(margin + "    ", "alpha", "alpha.exr", true) +
         texture(margin + "    ", "specular_reflectance", "specular.png", false) + margin + "  </bsdf>\n" + margin + "</bsdf>\n";
}

std::string material(bool with_normals) {
  if (!with_normals) return blend("    ");
  return "    <bsdf type=\"normalmap\" name=\"bsdf\">\n" + texture("      ", "normalmap", "normal.png", true) +
         "      <!-- known since 3.7.1; earlier versions have no such term and refuse the line -->\n" +
         "      <boolean name=\"use_shadowing_function\" value=\"false\"/>\n" + blend("      ") + "    </bsdf>\n";
}

std::string sensor(const View& view, double farthest_m) {
  // Mitsuba's cameras look along their z, with x to the left and y up.
  Eigen::Matrix4d world_from_camera = view.camera_from_world.inverse().matrix();
  world_from_camera.leftCols<2>() *= -1.0;
  std::ostringstream xml;
  xml << std::setprecision(12) << "  <sensor type=\"perspective\">\n    <string name=\"fov_axis\" value=\"x\"/>\n    <float name=\"fov\" value=\""
      << 2.0 * std::atan(0.5 * view.camera.width_px / view.camera.focal_x_px) * 180.0 / std::numbers::pi
      << "\"/>\n    <float name=\"near_clip\" value=\"" << 0.001 * farthest_m << "\"/>\n    <float name=\"far_clip\" value=\"" << 2.0 * farthest_m
      << "\"/>\n    <transform name=\"to_world\">\n      <matrix value=\"";
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) xml << (r + c > 0 ? " " : "") << world_from_camera(r, c);
  }
  xml << "\"/>\n    </transform>\n    <sampler type=\"independent\">\n      <integer name=\"sample_count\" value=\"16\"/>\n    </sampler>\n"
      << "    <film type=\"hdrfilm\">\n      <integer name=\"width\" value=\"" << view.camera.width_px
      << "\"/>\n      <integer name=\"height\" value=\"" << view.camera.height_px
      << "\"/>\n      <string name=\"file_format\" value=\"openexr\"/>\n      <string name=\"pixel_format\" value=\"rgb\"/>\n"
      << "      <string name=\"component_format\" value=\"float32\"/>\n      <rfilter type=\"box\"/>\n    </film>\n  </sensor>\n";
  return xml.str();
}

std::string lamp(const Light& light) {
  const Eigen::Vector3d& at = light.vector_in_world;
  std::ostringstream xml;
  xml << std::setprecision(12) << "  <emitter type=\"point\">\n    <point name=\"position\" x=\"" << at.x() << "\" y=\"" << at.y() << "\" z=\""
      << at.z() << "\"/>\n    <rgb name=\"intensity\" value=\"";
  for (std::size_t c = 0; c < 3; ++c) xml << (c > 0 ? " " : "") << light.intensity[std::min(c, light.intensity.size() - 1)];
  xml << "\"/>\n  </emitter>\n";
  return xml.str();
}

std::string scene(const Mesh& mesh, const View& view, bool with_normals, const ConversionLoss& loss) {
  const Eigen::Vector3d eye = view.camera_from_world.inverse().translation();
  double farthest_m = 0.0;
  for (const Eigen::Vector3d& position : mesh.positions) farthest_m = std::max(farthest_m, (position - eye).norm());
  return "<?xml version=\"1.0\"?>\n<!-- conversion_loss: " + loss_json(loss).dump() +
         "\n     Of this material, by Mitsuba's published formulas, against the model; lengths in metres, axes as the model's. -->\n" +
         "<scene version=\"3.0.0\">\n  <integrator type=\"direct\"/>\n" + sensor(view, farthest_m) + lamp(view.light) +
         "  <shape type=\"obj\">\n    <string name=\"filename\" value=\"mesh.obj\"/>\n    <boolean name=\"flip_tex_coords\" value=\"true\"/>\n" +
         material(with_normals) + "  </shape>\n</scene>\n";
}

}  // namespace

void write_mitsuba_scene(const std::filesystem::path& directory, const Model& model, const ExportedMaps& maps, const ConversionLoss& loss) {
  const View view = conversion_views(model.mesh, model.channels).front();
  Image alpha = maps.roughness;
  for (float& value : alpha.data) value *= value;
  write_png8(directory / "base.png", maps.base);
  write_png8(directory / "specular.png", maps.specular);
  write_png8(directory / "weight.png", maps.specular_factor);
  write_exr_colour(directory / "alpha.exr", alpha);
  if (maps.normal.channels > 0) write_png8(directory / "normal.png", maps.normal);
  write_obj(directory / "mesh.obj", model.mesh);
  write_reference(directory / "reference.exr", model, view);
  write_whole_file(directory / "scene.xml", scene(model.mesh, view, maps.normal.channels > 0, loss));
}

}  // namespace lumitexel
