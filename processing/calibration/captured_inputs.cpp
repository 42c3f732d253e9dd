#include "processing/calibration/captured_inputs.h"

#include "processing/calibration/lens/rig_camera.h"
#include "processing/surface/mesh_file.h"

namespace lumitexel {

CapturedInputs read_captured_inputs(const SessionStore& session) {
  CapturedInputs in;
  const std::string where = session.directory().string() + ": ";
  in.rig = parse_rig(session.document("rig.toml"), where + "rig.toml");
  in.plan = parse_plan(session.document("plan.toml"), where + "plan.toml");
  if (!in.plan.views.empty()) in.mesh = parse_mesh(session.document("mesh.ply"), ".ply", where + "mesh.ply");
  if (session.has_document("lens.json")) {
    in.lens = parse_lens_record(session.document("lens.json"), where + "lens.json");
  }
  in.nominal_camera = camera_model_of(in.rig.camera);
  in.nominal_sensor = linear_sensor(in.rig.camera, in.plan.gain_db);
  return in;
}

std::vector<ViewFrames> frames_of_views(const CapturedFrames& frames, const CapturePlan& plan) {
  std::vector<ViewFrames> views;
  for (const PlannedView& view : plan.views) {
    views.push_back(
        {frames.of(ShotKind::Object, view.name),
         frames.of(ShotKind::Silhouette, view.name)[0],
         {frames.of(ShotKind::SpheresRing, view.name)[0], frames.of(ShotKind::SpheresPoint, view.name)[0]}});
  }
  return views;
}

}  // namespace lumitexel
