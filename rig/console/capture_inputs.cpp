#include "rig/console/capture_inputs.h"

#include <filesystem>

#include "drivers/error.h"
#include "processing/calibration/import/import_layout.h"
#include "processing/calibration/lens/rig_camera.h"
#include "processing/surface/mesh_file.h"
#include "rig/rig_file.h"
#include "rig/schedule.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

Mesh coarse_mesh(const CapturePlan& plan, const std::string& plan_file, const std::string& mesh_file,
                 const RigBackend& backend) {
  if (!mesh_file.empty()) return read_mesh(mesh_file);
  if (plan.mesh != "scan") return read_mesh(fs::path(plan_file).parent_path() / plan.mesh);
  if (!backend.scan) throw BadInput(plan_file + ": mesh", "'scan'", "a mesh file, here or by --mesh: this rig has no scanner");
  return backend.scan();
}

void require_in_sight(const Mesh& mesh, const CaptureInputs& inputs, const std::string& plan_file) {
  for (const PlannedView& planned : inputs.plan.views) {
    View view;
    view.camera = camera_model_of(inputs.rig.camera);
    view.camera_from_world =
        inputs.rig.camera.camera_from_rig * inputs.rig.turntable.rig_from_table(planned.turntable_deg);
    if (has_in_sight(view, mesh)) continue;
    throw BadInput(plan_file + ": view " + planned.name, "no part of the mesh " + inputs.plan.mesh + " is in its picture",
                   "a mesh in metres, in the turntable's frame, in the camera's sight");
  }
}

}  // namespace

CaptureInputs read_capture_inputs(const std::string& rig_file, const std::string& plan_file,
                                  const std::string& mesh_file) {
  CaptureInputs inputs;
  inputs.documents["rig.toml"] = read_rig_file(rig_file);
  inputs.documents["plan.toml"] = read_whole_file(plan_file);
  // So that what the rig's file names relative to itself is found again on resuming.
  inputs.documents["rig.path"] = fs::absolute(rig_file).lexically_normal().string();
  inputs.rig = parse_rig(inputs.documents["rig.toml"], rig_file);
  inputs.plan = parse_plan(inputs.documents["plan.toml"], plan_file);
  inputs.shots = schedule_shots(inputs.plan, inputs.rig, plan_file);
  inputs.backend = rig_backend(inputs.rig, rig_file);
  if (inputs.plan.views.empty()) return inputs;  // for the lens alone: no object
  const Mesh mesh = coarse_mesh(inputs.plan, plan_file, mesh_file, inputs.backend);
  require_in_sight(mesh, inputs, plan_file);
  inputs.documents["mesh.ply"] = encode_ply(mesh);
  return inputs;
}

}  // namespace lumitexel
