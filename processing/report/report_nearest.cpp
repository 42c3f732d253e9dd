#include <nlohmann/json.hpp>

#include "processing/report/html.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostNamed = 3;
// nearest_material.h: at about 0.05 spheres begin to look different. The others are multiples of it.
constexpr double kLooksAlike = 0.05, kSimilar = 0.1, kAkin = 0.2;

std::string in_words(double distance) {
  if (distance < kLooksAlike) return "hardly to be told apart";
  if (distance < kSimilar) return "similar";
  return distance < kAkin ? "akin, clearly different" : "none known is like it";
}

}  // namespace

Json nearest_json(const ReportSubject& subject) {
  Json all = Json::array();
  for (const ModelMaterial& material : subject.model.materials) {
    Json near = Json::array();
    for (const NearMaterial& candidate : nearest_materials(material.brdf, subject.known)) {
      if (near.size() < kMostNamed) near.push_back({{"name", subject.known[candidate.index].name}, {"distance", candidate.distance}});
    }
    all.push_back(near);
  }
  return all;
}

std::string nearest_section(const ReportSubject& subject, const Json& nearest, const Json& known) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t m = 0; m < nearest.size(); ++m) {
    if (nearest[m].empty()) continue;
    std::vector<std::string> row{"material " + std::to_string(m)};
    for (const Json& near : nearest[m]) row.push_back(near.at("name").get<std::string>() + " (" + html::number(near.at("distance").get<double>(), 2) + ")");
    row.resize(1 + kMostNamed, "–");
    row.insert(row.begin() + 1, in_words(nearest[m][0].at("distance").get<double>()));
    rows.push_back(row);
  }
  if (rows.empty()) return "";
  return html::section("What the materials resemble",
                       "Each material beside the " + known.dump() +
                           (subject.known_source.empty() ? " materials known" : " of " + subject.known_source) +
                           ", the nearest first. A likeness in how light is reflected, which does not say what the material is made of. In "
                           "brackets the distance: root mean square difference of cube roots of f cos over light and view directions. 0 is the "
                           "same; from about 0.05 on spheres begin to look different.",
                       html::table({"", "the nearest is", "nearest", "second", "third"}, rows));
}

}  // namespace lumitexel
