#include "rig/console/recorded_rig.h"

#include "drivers/error.h"
#include "processing/surface/mesh_file.h"
#include "rig/recorded_devices.h"

namespace lumitexel {

namespace fs = std::filesystem;

RigBackend recorded_rig(const RigDescription& rig, const std::string& where) {
  if (rig.recorded_session.empty()) {
    throw BadInput(where + ": recorded.session", "missing", "the folder of the session to play back");
  }
  const fs::path place = fs::path(where).parent_path() / rig.recorded_session;
  std::shared_ptr<const SessionStore> recording;
  try {
    recording = std::make_shared<const SessionStore>(SessionStore::open(place, OpenMode::ReadOnly));
  } catch (const BadInput& error) {
    throw BadInput(where + ": recorded.session", error.what(), "the folder of a captured session");
  }
  RigBackend backend;
  backend.connect = [recording](std::stop_token) {
    return make_recorded_devices(recording, recorded_frames(*recording));
  };
  backend.scan = [recording] {
    return parse_mesh(recording->document("mesh.ply"), ".ply", recording->directory().string() + ": mesh.ply");
  };
  if (fs::is_directory(place / "truth")) {
    backend.write_truth = [place](const CapturePlan&, const fs::path& truth_directory) {
      fs::copy(place / "truth", truth_directory, fs::copy_options::recursive);
    };
  }
  return backend;
}

}  // namespace lumitexel
