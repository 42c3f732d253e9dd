#include "processing/surface/ray_scene.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "drivers/error.h"

namespace lumitexel {

// Embree works in single precision: coordinates are taken relative to the mesh's centre, so that an object far from the
// origin keeps its digits.
struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double diagonal_m = 0;

  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void set_ray(RTCRay& ray, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near_m,
               double far_m) const {
    const Eigen::Vector3f start = (origin - centre).cast<float>();
    ray.org_x = start.x();
    ray.org_y = start.y();
    ray.org_z = start.z();
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tnear = static_cast<float>(near_m);
    ray.tfar = static_cast<float>(far_m);
    ray.time = 0.0f;
    ray.mask = 0xffffffffu;
    ray.id = 0;
    ray.flags = 0;
  }
};

RayScene::RayScene(const Mesh& mesh, const std::string& instruction_set) : embree_(std::make_unique<Embree>()) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& position : mesh.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  embree_->centre = 0.5 * (low + high);
  embree_->diagonal_m = (high - low).norm();

  embree_->device = rtcNewDevice(instruction_set.empty() ? nullptr : ("isa=" + instruction_set).c_str());
  if (embree_->device == nullptr) throw Error("Embree: no device could be created");
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);  // no light through the seam of two triangles
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.positions.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const Eigen::Vector3d& position : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(position[axis] - embree_->centre[axis]);
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) *indices++ = vertex;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
}

RayScene::~RayScene() = default;

std::optional<RayHit> RayScene::closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                        double min_distance_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  embree_->set_ray(query.ray, origin, direction, min_distance_m, std::numeric_limits<double>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return RayHit{query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
}

bool RayScene::occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double min_distance_m,
                        double max_distance_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  embree_->set_ray(ray, from, direction, min_distance_m, max_distance_m);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0.0f;  // Embree sets -infinity on a hit
}

double RayScene::surface_offset_m() const { return 1e-5 * embree_->diagonal_m; }

}  // namespace lumitexel
