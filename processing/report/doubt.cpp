#include "processing/report/doubt.h"

#include <algorithm>
#include <cmath>

#include "processing/brdf/highlight.h"
#include "processing/normals/texel_normal.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

struct Look {
  Eigen::Vector3d wi, wo;
};

// From the photographs of the fit that see the point lit, as gather_lumitexels has it but for the edges of depth and shadow.
std::vector<Look> looks_at(const ModelSurface& surface, const CalibratedSession& session, const TexturedPoint& point) {
  std::vector<Look> looks;
  for (const View& view : session.views) {
    if (view.heldout) continue;
    Light eye;
    eye.vector_in_world = view.camera_in_world();
    const Eigen::Vector3d wi = view.light.direction_from(point.position_in_world), wo = eye.direction_from(point.position_in_world);
    if (std::min(wi.dot(point.vertex_normal), wo.dot(point.vertex_normal)) < kGrazingCosine) continue;
    if (surface.sees(point, view.light) && surface.sees(point, eye)) looks.push_back({wi, wo});
  }
  return looks;
}

double predicted(const Model& model, const TexelShare& texel, const Eigen::Vector3d& normal, const Look& look) {
  const LobeGeometry geometry = lobe_geometry(normal, look.wi, look.wo);
  double sum = 0.0;
  for (int c = 0; c < model.channels; ++c) sum += evaluate_texel(model, FitStage::Normal, texel.x, texel.y, c, geometry);
  return sum / model.channels * std::max(0.0, geometry.cos_i);
}

// Root mean square change of the predictions when the normal turns by one sigma either way, over their root mean square.
double change_by_normal(const Model& model, const TexelShare& texel, const Eigen::Vector3d& normal, const std::vector<Look>& looks) {
  if (model.normal_sigma.data.empty()) return 0.0;
  const double sigma_rad = model.normal_sigma.at(texel.x, texel.y);
  const TangentFrame frame = tangent_frame(normal);
  double changes = 0.0, squares = 0.0;
  for (const Look& look : looks) {
    const double here = predicted(model, texel, normal, look);
    squares += here * here;
    for (const int axis : {0, 1}) {
      const Eigen::Vector2d step = sigma_rad * Eigen::Vector2d::Unit(axis);
      const double slope = 0.5 * (predicted(model, texel, moved(normal, frame, step), look) - predicted(model, texel, moved(normal, frame, -step), look));
      changes += slope * slope;
    }
  }
  return squares > 0.0 ? std::sqrt(changes / squares) : 0.0;
}

int material_of(const Model& model, const TexelShare& texel) {
  return model.material[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(texel.x)];
}

}  // namespace

const char* to_string(Doubt doubt) {
  switch (doubt) {
    case Doubt::Normal: return "normal";
    case Doubt::NoHighlight: return "no highlight";
    case Doubt::FewSamples: return "few samples";
    case Doubt::Scatter: return "scatter";
  }
  return "";
}

std::optional<Doubt> doubt_at(const ModelSurface& surface, const CalibratedSession& session, const TexturedPoint& point) {
  const Model& model = surface.model();
  if (point.texel_count == 0) return std::nullopt;
  const TexelShare& texel = nearest_texel(point);
  const float samples = model.samples.at(texel.x, texel.y);
  if (!(samples > 0.0f)) return std::nullopt;
  const ModelMaterial& material = model.materials[static_cast<std::size_t>(material_of(model, texel))];
  const Eigen::Vector3d normal = surface.shading_normal(texel, point, FitStage::Normal);
  const std::vector<Look> looks = looks_at(surface, session, point);
  if (change_by_normal(model, texel, normal, looks) > model.uncertainty.at(texel.x, texel.y)) return Doubt::Normal;
  const auto near = [&](const Look& look) { return near_highlight(material.brdf, lobe_geometry(normal, look.wi, look.wo)); };
  if (has_highlight(material.brdf) && std::none_of(looks.begin(), looks.end(), near)) return Doubt::NoHighlight;
  return samples < static_cast<float>(material.basis.size()) ? Doubt::FewSamples : Doubt::Scatter;
}

std::vector<DoubtfulPoint> doubts_over_surface(const ModelSurface& surface, const CalibratedSession& session, int count) {
  const Mesh& mesh = surface.model().mesh;
  std::vector<double> area{0.0};  // of the triangles so far
  std::vector<Eigen::Vector3d> normal;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d twice = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    area.push_back(area.back() + 0.5 * twice.norm());
    normal.push_back(twice.normalized());
  }
  std::vector<DoubtfulPoint> points;
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;  // Roberts' R2 sequence
  for (int i = 0; i < count; ++i) {
    const auto after = std::upper_bound(area.begin() + 1, area.end(), (i + 0.5) / count * area.back());
    const auto triangle = std::min(static_cast<std::size_t>(after - area.begin()) - 1, mesh.triangles.size() - 1);
    double u = std::fmod(kStepU * i, 1.0), v = std::fmod(kStepV * i, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Eigen::Vector3d at = (1.0 - u - v) * mesh.positions[a] + u * mesh.positions[b] + v * mesh.positions[c];
    const double step_m = 1e-3 * std::sqrt(area[triangle + 1] - area[triangle]);
    const auto point = surface.trace(at + step_m * normal[triangle], -normal[triangle]);
    if (!point) continue;
    if (const std::optional<Doubt> doubt = doubt_at(surface, session, *point))
      points.push_back({material_of(surface.model(), nearest_texel(*point)), *doubt});
  }
  return points;
}

}  // namespace lumitexel
