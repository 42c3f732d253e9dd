#include "processing/fit/unseen_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <limits>

#include "drivers/error.h"

namespace lumitexel {
namespace {

struct Cameras {
  int count = 0, with_middle = 0;
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0;
};

Cameras cameras_about(const Eigen::Vector3d& middle, const CalibratedSession& session) {
  Cameras cameras;
  for (const View& view : session.views) {
    if (view.heldout) continue;
    const Eigen::Vector3d in_camera = view.camera_from_world * middle;
    ++cameras.count;
    cameras.with_middle += in_camera.z() > 0.0 && view.camera.contains(view.camera.project(in_camera));
    cameras.nearest_m = std::min(cameras.nearest_m, in_camera.norm());
    cameras.farthest_m = std::max(cameras.farthest_m, in_camera.norm());
  }
  return cameras;
}

}  // namespace

void refuse_unseen_mesh(const CalibratedSession& session) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : session.mesh.positions) box.extend(position);
  const Eigen::Vector3d size = box.sizes(), middle = box.center();
  const Cameras cameras = cameras_about(middle, session);
  if (cameras.count == 0) throw BadInput("session", "no photograph to fit to: all are held out", "at least one that is not");
  char what[300];
  std::snprintf(what, sizeof what,
                "no photograph sees any of its triangles: it measures %.3g x %.3g x %.3g m about (%.3g, %.3g, %.3g), the cameras stand %.3g to %.3g m from there, "
                "and %d of %d have its middle in their pictures",
                size.x(), size.y(), size.z(), middle.x(), middle.y(), middle.z(), cameras.nearest_m, cameras.farthest_m, cameras.with_middle, cameras.count);
  throw BadInput("mesh", what, "a mesh in metres, not millimetres, in the frame of the poses, with triangles counter-clockwise seen from outside");
}

}  // namespace lumitexel
