#include "processing/export/materialx_file.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "processing/export/loss_json.h"
#include "processing/export/obj_file.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

constexpr double kDielectricF0 = 0.04;  // what specular_color multiplies

std::string image_node(const std::string& name, const std::string& type, const std::string& file, const std::string& space) {
  const std::string colourspace = space.empty() ? "" : " colorspace=\"" + space + "\"";
  return "    <image name=\"" + name + "\" type=\"" + type + "\">\n      <input name=\"file\" type=\"filename\" value=\"" + file + "\"" +
         colourspace + "/>\n      <input name=\"uaddressmode\" type=\"string\" value=\"clamp\"/>\n" +
         "      <input name=\"vaddressmode\" type=\"string\" value=\"clamp\"/>\n    </image>\n";
}

std::string output(const std::string& node, const std::string& type) {
  return "    <output name=\"" + node + "_out\" type=\"" + type + "\" nodename=\"" + node + "\"/>\n";
}

std::string graph(const ExportedMaps& maps) {
  std::ostringstream xml;
  xml << std::setprecision(9) << "  <nodegraph name=\"textures\">\n" << image_node("base", "color3", "base.png", "srgb_texture")
      << image_node("specular_share", "color3", "specular.png", "srgb_texture") << image_node("roughness", "float", "roughness.png", "")
      << image_node("specular_factor", "float", "specular_factor.png", "")
      << "    <multiply name=\"specular\" type=\"color3\">\n      <input name=\"in1\" type=\"color3\" nodename=\"specular_share\"/>\n"
      << "      <input name=\"in2\" type=\"float\" value=\"" << maps.most_share / kDielectricF0 << "\"/>\n    </multiply>\n";
  if (maps.normal.channels > 0) {
    xml << image_node("coded_normal", "vector3", "normal.png", "")
        << "    <normalmap name=\"normal\" type=\"vector3\">\n      <input name=\"in\" type=\"vector3\" nodename=\"coded_normal\"/>\n    </normalmap>\n"
        << output("normal", "vector3");
  }
  xml << output("base", "color3") << output("specular", "color3") << output("roughness", "float")
      << output("specular_factor", "float") << "  </nodegraph>\n";
  return xml.str();
}

std::string input(const std::string& name, const std::string& type, const std::string& node) {
  return "    <input name=\"" + name + "\" type=\"" + type + "\" nodegraph=\"textures\" output=\"" + node + "_out\"/>\n";
}

std::string document(const ExportedMaps& maps, const ConversionLoss& loss) {
  // JSON in an attribute of its own: MaterialX keeps attributes that it does not know. Single quotes, so JSON's may stay.
  std::string xml = "<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n" + graph(maps) +
                    "  <gltf_pbr name=\"refitted\" type=\"surfaceshader\" conversion_loss='" + loss_json(loss).dump() + "'>\n" +
                    input("base_color", "color3", "base") + input("specular_color", "color3", "specular") +
                    input("specular", "float", "specular_factor") + input("roughness", "float", "roughness") +
                    "    <input name=\"metallic\" type=\"float\" value=\"0\"/>\n";
  if (maps.normal.channels > 0) xml += input("normal", "vector3", "normal");
  return xml + "  </gltf_pbr>\n  <surfacematerial name=\"model\" type=\"material\">\n" +
         "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"refitted\"/>\n  </surfacematerial>\n</materialx>\n";
}

}  // namespace

void write_materialx(const std::filesystem::path& directory, const Mesh& mesh, const ExportedMaps& maps, const ConversionLoss& loss) {
  write_png8(directory / "base.png", maps.base);
  write_png8(directory / "specular.png", maps.specular);
  write_png8(directory / "roughness.png", maps.roughness);
  write_png8(directory / "specular_factor.png", maps.specular_factor);
  if (maps.normal.channels > 0) write_png8(directory / "normal.png", maps.normal);
  write_obj(directory / "mesh.obj", mesh);
  write_whole_file(directory / "model.mtlx", document(maps, loss));
}

}  // namespace lumitexel
