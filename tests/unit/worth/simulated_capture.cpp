#include "tests/unit/worth/simulated_capture.h"

#include <cmath>
#include <fstream>

#include "processing/surface/mesh_file.h"
#include "rig/new_session.h"
#include "rig/rig_file.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "rig/whole_file.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

// The rig with another seed and a picture of fewer pixels, as the text of its file.
std::string rig_text(const SimulatedCapture& what, int seed, const fs::path& folder) {
  const fs::path rig = fs::absolute(what.rig);
  const RigDescription full = parse_rig(read_rig_file(rig), rig.string());
  const LensDescription& lens = full.camera.lens;
  const double s = what.scale;
  const fs::path file = folder / "rig.toml";
  std::ofstream text(file);
  text.precision(12);
  text << "base = \"" << rig.string() << "\"\n[camera]\nwidth_px = " << std::lround(s * full.camera.limits.width_px)
       << "\nheight_px = " << std::lround(s * full.camera.limits.height_px) << "\nfocal_px = [" << s * lens.focal_x_px << ", "
       << s * lens.focal_y_px << "]\nprincipal_px = [" << s * lens.principal_x_px << ", " << s * lens.principal_y_px
       << "]\n[simulation]\nseed = " << seed << '\n'
       << what.simulation_toml << '\n';
  text.close();
  return read_rig_file(file);
}

}  // namespace

CapturedWorld capture_simulated(const SimulatedCapture& what, int seed, const fs::path& folder) {
  SessionContent content;
  content.documents["rig.toml"] = rig_text(what, seed, folder);
  content.documents["plan.toml"] = read_whole_file(what.plan);
  content.documents["rig.path"] = fs::absolute(what.rig).string();
  const RigDescription rig = parse_rig(content.documents["rig.toml"], what.rig.string());
  const CapturePlan plan = parse_plan(content.documents["plan.toml"], what.plan.string());
  content.shots = schedule_shots(plan, rig, what.plan.string());
  const auto world = build_world(rig, what.rig.string());
  content.documents["mesh.ply"] = encode_ply(scanned_mesh(*world));
  content.add_files = [&](const fs::path& directory) { write_truth(*world, rig, plan, directory / "truth"); };
  SessionStore session = begin_session(folder / "session", content);
  RigDevices devices = make_simulated_devices(rig, world);
  NoProgress quiet;
  take_missing_shots(session, devices, quiet, {});
  return {world, plan, std::move(session)};
}

}  // namespace lumitexel
