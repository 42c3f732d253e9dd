#include "processing/export/blender_scene.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "processing/export/loss_json.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "mesh.bin is little endian");

template <typename T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

// Positions and normals (3 floats a vertex each), texture coordinates (2), then three 32-bit indices a triangle.
std::string mesh_bytes(const Mesh& mesh) {
  std::string bytes;
  for (const auto* vectors : {&mesh.positions, &mesh.normals}) {
    for (const Eigen::Vector3d& vector : *vectors) {
      for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(vector[k]));
    }
  }
  for (const Eigen::Vector2d& uv : mesh.texcoords) {
    append(bytes, static_cast<float>(uv.x()));
    append(bytes, static_cast<float>(uv.y()));
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) append(bytes, vertex);
  }
  return bytes;
}

json scene_json(const Model& model, const ExportedMaps& maps, const ConversionLoss& loss, const View& view) {
  // Blender's cameras look along their -z, with y up.
  Eigen::Matrix4d world_from_camera = view.camera_from_world.inverse().matrix();
  world_from_camera.middleCols<2>(1) *= -1.0;
  json rows = json::array();
  for (int r = 0; r < 4; ++r) {
    rows.push_back({world_from_camera(r, 0), world_from_camera(r, 1), world_from_camera(r, 2), world_from_camera(r, 3)});
  }
  const Eigen::Vector3d lamp = view.light.vector_in_world;
  const std::vector<double>& power = view.light.intensity;
  return {{"conversion_loss", loss_json(loss)}, {"vertices", model.mesh.positions.size()}, {"triangles", model.mesh.triangles.size()},
          {"most_share", maps.most_share}, {"own_normals", maps.normal.channels > 0}, {"width_px", view.camera.width_px}, {"height_px", view.camera.height_px},
          {"field_of_view_x_rad", 2.0 * std::atan(0.5 * view.camera.width_px / view.camera.focal_x_px)},
          {"world_from_camera", rows}, {"lamp_m", {lamp.x(), lamp.y(), lamp.z()}},
          {"lamp_intensity", {power[0], power[power.size() > 1 ? 1 : 0], power[power.size() > 2 ? 2 : 0]}}};
}

constexpr const char* kScript = R"PY(# Builds the scene of scene.json (its conversion_loss: what the material loses against the model).
# Render it and compare it with reference.exr: blender -b --python scene.py -- OUT.exr
import array, json, math, os, sys
import bpy
from mathutils import Matrix

HERE = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(HERE, "scene.json")) as file:
    SCENE = json.load(file)


def read(file, kind, count):
    values = array.array(kind)
    values.fromfile(file, count)
    return values


def groups(values, size):
    return list(zip(*[iter(values)] * size))


def build_mesh():
    n, t = SCENE["vertices"], SCENE["triangles"]
    with open(os.path.join(HERE, "mesh.bin"), "rb") as file:
        positions, normals = groups(read(file, "f", 3 * n), 3), groups(read(file, "f", 3 * n), 3)
        uvs, triangles = groups(read(file, "f", 2 * n), 2), groups(read(file, "I", 3 * t), 3)
    mesh = bpy.data.meshes.new("model")
    mesh.from_pydata(positions, [], triangles)
    layer = mesh.uv_layers.new(name="atlas")
    for loop in mesh.loops:
        layer.data[loop.index].uv = uvs[loop.vertex_index]
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if hasattr(mesh, "use_auto_smooth"):  # until Blender 4.0
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set_from_vertices(normals)
    return mesh


def image(nodes, name, space):
    node = nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(os.path.join(HERE, name))
    node.image.colorspace_settings.name = space
    node.extension = "EXTEND"
    return node.outputs["Color"]


def build_material():
    material = bpy.data.materials.new("refitted")
    material.use_nodes = True
    nodes, link = material.node_tree.nodes, material.node_tree.links.new
    nodes.clear()

    def math_node(operation, a, b):
        node = nodes.new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, (a, b)):
            if isinstance(value, float):
                socket.default_value = value
            else:
                link(value, socket)
        return node.outputs[0]

    def scaled(vector, factor):
        node = nodes.new("ShaderNodeVectorMath")
        node.operation = "SCALE"
        link(vector, node.inputs[0])
        if isinstance(factor, float):
            node.inputs["Scale"].default_value = factor
        else:
            link(factor, node.inputs["Scale"])
        return node.outputs["Vector"]

    factor = image(nodes, "specular_factor.png", "Non-Color")
    share = scaled(image(nodes, "specular.png", "sRGB"), SCENE["most_share"])
    parts = nodes.new("ShaderNodeSeparateXYZ")
    link(scaled(share, factor), parts.inputs[0])  # F0
    largest = math_node("MAXIMUM", math_node("MAXIMUM", parts.outputs[0], parts.outputs[1]), parts.outputs[2])
    diffuse, glossy = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeBsdfPrincipled")
    link(scaled(image(nodes, "base.png", "sRGB"), math_node("SUBTRACT", 1.0, largest)), diffuse.inputs["Color"])
    link(share, glossy.inputs["Base Color"])
    glossy.inputs["Metallic"].default_value = 1.0
    glossy.distribution = "GGX"
    link(image(nodes, "roughness.png", "Non-Color"), glossy.inputs["Roughness"])
    if SCENE["own_normals"]:
        normal = nodes.new("ShaderNodeNormalMap")
        normal.space = "OBJECT"
        link(image(nodes, "normal_world.png", "Non-Color"), normal.inputs["Color"])
        for shader in (diffuse, glossy):
            link(normal.outputs["Normal"], shader.inputs["Normal"])
    highlights = nodes.new("ShaderNodeMixShader")  # by the factor, with nothing: the first shader stays empty
    link(factor, highlights.inputs["Fac"])
    link(glossy.outputs[0], highlights.inputs[2])
    both, output = nodes.new("ShaderNodeAddShader"), nodes.new("ShaderNodeOutputMaterial")
    link(diffuse.outputs[0], both.inputs[0])
    link(highlights.outputs[0], both.inputs[1])
    link(both.outputs[0], output.inputs["Surface"])
    return material


def add(scene, name, data):
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def build_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    mesh = build_mesh()
    mesh.materials.append(build_material())
    add(scene, "model", mesh)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "HORIZONTAL"
    camera.angle_x = SCENE["field_of_view_x_rad"]
    world_from_camera = Matrix(SCENE["world_from_camera"])
    distance = max((v.co - world_from_camera.translation).length for v in mesh.vertices)
    camera.clip_start, camera.clip_end = 0.001 * distance, 2.0 * distance
    scene.camera = add(scene, "camera", camera)
    scene.camera.matrix_world = world_from_camera
    lamp = bpy.data.lights.new("lamp", "POINT")
    strongest = max(SCENE["lamp_intensity"])
    lamp.energy = 4.0 * math.pi * strongest  # W over the whole sphere
    lamp.color = [value / strongest for value in SCENE["lamp_intensity"]]
    lamp.shadow_soft_size = 0.0
    add(scene, "lamp", lamp).location = SCENE["lamp_m"]
    if scene.world is None:
        scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    return scene


def set_render(scene):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 16
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0  # the reference has direct light alone
    scene.cycles.sample_clamp_direct = 0.0
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.blur_glossy = 0.0
    scene.render.resolution_x, scene.render.resolution_y = SCENE["width_px"], SCENE["height_px"]
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"


def pixels(path):
    loaded = bpy.data.images.load(path)
    values = array.array("f", bytes(4 * len(loaded.pixels)))
    loaded.pixels.foreach_get(values)
    return values


def compare(rendered, reference):
    """PSNR over the pixels that the reference lights, its 99.9th percentile being the peak."""
    ours, theirs = pixels(reference), pixels(rendered)
    lit = [p + c for p in range(0, len(ours), 4) if sum(ours[p:p + 3]) > 0.0 for c in range(3)]
    peak = sorted(ours[i] for i in lit)[math.ceil(0.999 * len(lit)) - 1]
    squares = sum((ours[i] - theirs[i]) ** 2 for i in lit) / len(lit)
    print("PSNR against reference.exr: %.1f dB" % (10.0 * math.log10(peak * peak / squares)))


scene = build_scene()
set_render(scene)
if "--" in sys.argv:
    scene.render.filepath = os.path.abspath(sys.argv[sys.argv.index("--") + 1])
    bpy.ops.render.render(write_still=True)
    compare(scene.render.filepath, os.path.join(HERE, "reference.exr"))
)PY";

}  // namespace

void write_blender_scene(const std::filesystem::path& directory, const Model& model, const RefittedAtlas& atlas, const ExportedMaps& maps,
                         const ConversionLoss& loss) {
  const View view = conversion_views(model.mesh, model.channels).front();
  write_png8(directory / "base.png", maps.base);
  write_png8(directory / "specular.png", maps.specular);
  write_png8(directory / "roughness.png", maps.roughness);
  write_png8(directory / "specular_factor.png", maps.specular_factor);
  if (maps.normal.channels > 0) write_png8(directory / "normal_world.png", coded_normals(atlas.normals.world));
  write_whole_file(directory / "mesh.bin", mesh_bytes(model.mesh));
  write_whole_file(directory / "scene.json", scene_json(model, maps, loss, view).dump(1) + "\n");
  write_whole_file(directory / "scene.py", kScript);
  write_reference(directory / "reference.exr", model, view);
}

}  // namespace lumitexel
