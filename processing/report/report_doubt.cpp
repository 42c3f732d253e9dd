#include <nlohmann/json.hpp>

#include "processing/report/doubt.h"
#include "processing/report/html.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr int kSurfacePoints = 6000;  // shares to within about a hundredth
constexpr int kPictureStep = 2;       // pixels of the other maps that one of this picture's takes

struct DoubtWords {
  std::array<float, 3> colour;
  const char* title;
  const char* meaning;
};

DoubtWords words_of(Doubt doubt) {
  switch (doubt) {
    case Doubt::Normal: return {{0.46f, 0.42f, 0.70f}, "the normal", "which way the surface faces matters more than all else: more lamp positions or a finer mesh"};
    case Doubt::NoHighlight: return {{0.85f, 0.37f, 0.01f}, "no highlight seen", "shiny, and no photograph looked near the mirror direction: more lamp positions"};
    case Doubt::FewSamples: return {{0.90f, 0.67f, 0.01f}, "few photographs", "fewer samples than functions that the material mixes: more views"};
    case Doubt::Scatter: return {{0.70f, 0.74f, 0.78f}, "scatter", "seen often enough; left are noise and what the material's functions cannot describe"};
  }
  return {};
}

Json shares_json(const std::array<double, kDoubts.size()>& counts, double total) {
  Json shares = Json::object();
  for (const Doubt doubt : kDoubts) shares[to_string(doubt)] = total > 0.0 ? Json(counts[static_cast<std::size_t>(doubt)] / total) : Json(nullptr);
  return shares;
}

Image picture_of(const ModelSurface& surface, const CalibratedSession& session, const View& view) {
  Image shown(view.camera.width_px / kPictureStep, view.camera.height_px / kPictureStep, 3, 1.0f);
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const Eigen::Vector3d ray = view.camera.unproject({kPictureStep * (x + 0.5), kPictureStep * (y + 0.5)});
      const auto point = surface.trace(world_from_camera.translation(), world_from_camera.linear() * ray);
      if (!point) continue;
      const std::optional<Doubt> doubt = doubt_at(surface, session, *point);
      const std::array<float, 3> colour = doubt ? words_of(*doubt).colour : std::array{0.25f, 0.27f, 0.30f};
      std::copy(colour.begin(), colour.end(), &shown.at(x, y));
    }
  }
  return shown;
}

std::vector<std::string> row_of(const std::string& name, const Json& shares) {
  std::vector<std::string> row{name};
  for (const Doubt doubt : kDoubts) {
    const Json& share = shares.at(to_string(doubt));
    row.push_back(share.is_number() ? html::number(100.0 * share.get<double>(), 2) + " %" : "–");
  }
  return row;
}

std::string key_list() {
  std::string list;
  for (const Doubt doubt : kDoubts) {
    const DoubtWords words = words_of(doubt);
    list += "<p><span class=\"key\" style=\"background:" + html::css_colour(words.colour) + "\"></span>" +
            html::escaped(std::string(words.title) + ": " + words.meaning + ".") + "</p>";
  }
  return list + "<p><span class=\"key\" style=\"background:#40454d\"></span>not measured.</p>";
}

}  // namespace

Json doubt_json(const ReportSubject& subject) {
  if (subject.session == nullptr) return nullptr;
  using Counts = std::array<double, kDoubts.size()>;
  Counts all{};
  std::vector<Counts> by_material(subject.model.materials.size());
  std::vector<double> total(by_material.size());
  const std::vector<DoubtfulPoint> points = doubts_over_surface(ModelSurface(subject.model), *subject.session, kSurfacePoints);
  for (const DoubtfulPoint& point : points) {
    const auto material = static_cast<std::size_t>(point.material), doubt = static_cast<std::size_t>(point.doubt);
    all[doubt] += 1.0;
    by_material[material][doubt] += 1.0;
    total[material] += 1.0;
  }
  Json materials = Json::array();
  for (std::size_t m = 0; m < by_material.size(); ++m) materials.push_back(shares_json(by_material[m], total[m]));
  return {{"points", points.size()}, {"shares", shares_json(all, static_cast<double>(points.size()))}, {"by_material", materials}};
}

std::string doubt_section(const ReportSubject& subject, const Json& data, const View& view) {
  if (!data.is_object() || data.at("points") == 0) return "";
  std::vector<std::string> header{"share of the measured surface"};
  for (const Doubt doubt : kDoubts) header.push_back(words_of(doubt).title);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t m = 0; m < data.at("by_material").size(); ++m) rows.push_back(row_of("material " + std::to_string(m), data.at("by_material")[m]));
  rows.push_back(row_of("all", data.at("shares")));
  const std::string picture = html::picture(picture_of(ModelSurface(subject.model), *subject.session, view), "what the uncertainty mostly comes from");
  return html::section("What the uncertainty mostly comes from",
                       "One cause a point, the first of this list that applies: a diagnosis by rule, not a division of the variance. It says what another session would have to change. Judged from where "
                       "cameras and lamps stood and from the model itself" +
                           std::string(has_normals(subject.model) ? "." : "; normals were not fitted, so that nothing is known of their part."),
                       "<div class=\"row two\"><div>" + html::figure(picture, "The same side as in the maps above.") + "</div><div>" + key_list() +
                           "</div></div>" + html::table(header, rows));
}

}  // namespace lumitexel
