#include "tests/unit/sphere_session.h"

#include <cmath>

#include "processing/surface/view_geometry.h"

namespace lumitexel {
namespace {

RadianceImage photograph_of(const View& view, const Mesh& mesh, const SurfaceBrdf& brdf, const RayScene& scene) {
  const ViewGeometry geometry = trace_view(view, mesh, scene);
  RadianceImage photograph{Image(geometry.width, geometry.height, 3), Image(geometry.width, geometry.height, 3, 1e-6f),
                           std::vector<std::uint8_t>(geometry.triangle.size(), 0)};
  for (std::size_t i = 0; i < geometry.triangle.size(); ++i) {
    if (geometry.triangle[i] == ViewGeometry::kNoTriangle) continue;
    const SurfacePoint point = surface_point(mesh, geometry.triangle[i], static_cast<double>(geometry.u[i]),
                                             static_cast<double>(geometry.v[i]));
    if (!is_lit(view.light, point, scene)) continue;
    const LobeGeometry directions =
        lobe_geometry(point.normal, view.light.direction_from(point.position), (view.camera_in_world() - point.position).normalized());
    const ChannelValues f = brdf(point.position, directions);
    for (std::size_t c = 0; c < 3; ++c) {
      photograph.radiance.data[3 * i + c] = static_cast<float>(f[c] * directions.cos_i * view.light.irradiance(point.position, static_cast<int>(c)));
    }
  }
  return photograph;
}

}  // namespace

Mesh sphere_mesh(double radius_m, int rings) {
  Mesh mesh;
  const int sectors = 2 * rings;
  const auto add = [&](const Eigen::Vector3d& normal) {
    mesh.normals.push_back(normal);
    mesh.positions.push_back(radius_m * normal);
  };
  add(Eigen::Vector3d::UnitZ());
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const double theta = M_PI * ring / rings, phi = 2.0 * M_PI * sector / sectors;
      add({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  add(-Eigen::Vector3d::UnitZ());
  const auto at = [&](int ring, int sector) {
    if (ring == 0) return 0u;
    if (ring == rings) return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    return static_cast<std::uint32_t>(1 + (ring - 1) * sectors + sector % sectors);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const std::uint32_t a = at(ring, sector), b = at(ring + 1, sector), c = at(ring + 1, sector + 1), d = at(ring, sector + 1);
      if (b != c) mesh.triangles.push_back({a, b, c});
      if (a != d) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

View view_of_origin(const std::string& name, const Eigen::Vector3d& eye, const Eigen::Vector3d& light) {
  View view;
  view.name = name;
  view.camera = {160, 120, 300.0, 300.0, 80.0, 60.0, 0.0, 0.0, 0.0, 0.0};
  const Eigen::Vector3d forward = -eye.normalized();
  const Eigen::Vector3d right = forward.cross(std::abs(forward.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX()).normalized();
  Eigen::Matrix3d camera_from_world;
  camera_from_world << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  view.camera_from_world.linear() = camera_from_world;
  view.camera_from_world.translation() = -camera_from_world * eye;
  view.light.vector_in_world = light;
  view.light.intensity = {10.0, 10.0, 10.0};
  return view;
}

CalibratedSession photographed_session(Mesh mesh, std::vector<View> views, const SurfaceBrdf& brdf, const TemporaryFolder& folder) {
  CalibratedSession session;
  session.channels = 3;
  session.mesh = std::move(mesh);
  session.key = "synthetic";
  const RayScene scene(session.mesh);
  for (View& view : views) {
    view.photograph = folder / (view.name + ".exr");
    write_radiance_image(view.photograph, photograph_of(view, session.mesh, brdf, scene));
  }
  session.views = std::move(views);
  return session;
}

CalibratedSession diffuse_session(Mesh mesh, std::vector<View> views, const TemporaryFolder& folder) {
  const double f = kSphereAlbedo / M_PI;
  return photographed_session(std::move(mesh), std::move(views), [f](const auto&, const auto&) { return ChannelValues{f, f, f}; }, folder);
}

CalibratedSession sphere_session(std::vector<View> views, const TemporaryFolder& folder) {
  return diffuse_session(sphere_mesh(0.1, 60), std::move(views), folder);
}

}  // namespace lumitexel
