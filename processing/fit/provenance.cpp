#include "processing/fit/provenance.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lumitexel {
namespace {

using nlohmann::json;

json rejected_json(const RejectionCounts& rejected) {
  return {{"outside_frame", rejected.outside_frame}, {"hidden", rejected.hidden},
          {"in_shadow", rejected.in_shadow},         {"near_depth_edge", rejected.near_depth_edge},
          {"near_shadow_edge", rejected.near_shadow_edge}, {"grazing", rejected.grazing},
          {"photograph_flag", rejected.photograph_flag}, {"in_penumbra", rejected.in_penumbra}};
}

json stages_json(const std::vector<StageCost>& stages) {
  json list = json::array();
  for (const StageCost& stage : stages) {
    list.push_back({{"name", stage.name}, {"seconds", stage.seconds}, {"peak_bytes", stage.peak_bytes}});
  }
  return list;
}

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

json choice_json(const std::string& fit, const Choice& choice) {
  return {{"fit", fit},
          {"of", choice.of},
          {"candidate", choice.candidate},
          {"over", choice.before},
          {"gain", finite_or_null(choice.gain.share)},
          {"gain_sigma", finite_or_null(choice.gain.sigma)},
          {"taken", choice.taken}};
}

json choices_json(const std::vector<FitChoices>& fits) {
  json list = json::array();
  for (const FitChoices& fit : fits) {
    for (const Choice& choice : fit.choices) list.push_back(choice_json(fit.fit, choice));
  }
  return list;
}

json prior_json(const std::vector<PriorChoice>& prior) {
  json list = json::array();
  for (const PriorChoice& choice : prior) {
    list.push_back({{"diffuse_width", finite_or_null(choice.prior.diffuse_width)},
                    {"gloss_width", finite_or_null(choice.prior.gloss_width)},
                    {"left_out_samples", choice.samples},
                    {"left_out_error", choice.left_out_error},
                    {"left_out_error_without", choice.left_out_error_without}});
  }
  return list;
}

json layout_json(const LayoutSummary& layout) {
  if (!layout.of_mesh) {
    return {{"from", "photographs"}, {"mesh_refused", layout.refused}, {"lumitexels_at_texels", layout.lumitexels_at_texels}};
  }
  return {{"from", "mesh"},
          {"pixels_a_texel", layout.pixels_a_texel},
          {"mirrored_triangles", layout.mirrored_triangles},
          {"shared_texels", layout.shared_texels}};
}

json counts_json(const CountByReason& count) {
  json object = json::object();
  for (const OutlierReason reason : kOutlierReasons) object[to_string(reason)] = count[static_cast<std::size_t>(reason)];
  return object;
}

json outlier_error_json(const std::optional<ErrorModel>& error) {
  if (!error) return nullptr;
  return {{"relative", error->relative}, {"floor", error->floor}};
}

json outliers_json(const Outliers& outliers, const CalibratedSession& session) {
  json by_view = json::object(), by_material = json::array();
  for (std::size_t v = 0; v < outliers.by_view.size(); ++v) {
    if (!session.views[v].heldout) by_view[session.views[v].name] = counts_json(outliers.by_view[v]);
  }
  for (const CountByReason& count : outliers.by_material) by_material.push_back(counts_json(count));
  return {{"beyond_scales", kOutlierScales},
          {"samples", outliers.samples},
          {"count", counts_json(outliers.count)},
          {"listed", outliers.worst.size()},
          {"by_view", by_view},
          {"by_material", by_material}};
}

json worth_json(const std::optional<IndirectWorth>& worth) {
  if (!worth) return nullptr;
  return {{"residual_slope", worth->slope},
          {"sigma", std::isfinite(worth->sigma) ? json(worth->sigma) : json(nullptr)},
          {"asked_for_slope", IndirectWorth::kLeastSlope},
          {"asked_for_sigmas", IndirectWorth::kStandardErrors},
          {"photographs", worth->photographs},
          {"samples", worth->samples},
          {"enough", worth->enough()}};
}

json indirect_json(const IndirectSummary& indirect, const IndirectOptions& light) {
  return {{"bounces", light.bounces},
          {"paths_a_sample", light.paths},
          {"largest_albedo", indirect.albedo},
          {"largest_bound", indirect.largest_bound},
          {"lumitexels_concerned", indirect.concerned},
          {"samples_followed", indirect.samples},
          {"share_of_reflectance", indirect.share},
          {"change_by_round", indirect.change},
          {"taken_out", indirect.share > 0.0},
          {"rounds_taken", indirect.rounds_taken},
          {"shown_by_photographs", worth_json(indirect.worth)},
          {"dropped_paths", indirect.dropped_paths}};
}

}  // namespace

std::string provenance_json(const CalibratedSession& session, const FitOptions& options, const FitSummary& summary) {
  json object;
  object["session_key"] = session.key;
  object["options"] = {{"quality", options.quality},
                       {"method", options.method == FitMethod::Paper ? "paper" : "lumitexel"},
                       {"family", options.family ? to_string(*options.family) : "auto"},
                       {"most_lobes", options.most_lobes},
                       {"principal_functions", options.principal_functions},
                       {"normals", to_string(options.normals)},
                       {"interreflections", to_string(options.interreflections.choice)},
                       {"intensity_weight", options.method == FitMethod::Paper ? json(options.intensity_weight) : json(nullptr)},
                       {"materials", options.materials},
                       {"layout", to_string(options.layout.choice)},
                       {"atlas_size", options.layout.size},
                       {"learning_lumitexels", options.learning_lumitexels},
                       {"draw", options.draw},
                       {"final_lumitexels", options.final_lumitexels},
                       {"lobe_shapes", to_string(options.lobe_shapes)},
                       {"bases", options.bases == 0 ? json("auto") : json(options.bases)},
                       {"precision", to_string(options.precision)},
                       {"plain_projection", options.plain_projection},
                       {"errors", options.method == FitMethod::Paper ? json(nullptr) : json(to_string(options.errors))},
                       {"relative_error", summary.error.relative},
                       {"error_floor", summary.error.floor}};
  // What came of the choices: never "auto".
  const bool paper = options.method == FitMethod::Paper;
  object["errors"] = paper ? json(nullptr) : json(to_string(summary.errors));  // the paper's method has its own, eq. 6
  object["family"] = to_string(summary.family);
  object["choices"] = choices_json(summary.choices);
  object["lobes_by_material"] = summary.lobes_by_material;
  object["bases_by_material"] = summary.bases_by_material;
  object["lobe_shapes"] = to_string(summary.lobe_shapes);
  object["materials"] = summary.texels_by_material.size();
  object["layout"] = layout_json(summary.layout);
  object["lumitexels"] = summary.lumitexels;
  object["samples"] = summary.samples;
  object["starved_lumitexels"] = summary.starved;
  object["unseen_triangles"] = summary.unseen_triangles;
  object["rejected"] = rejected_json(summary.rejected);
  object["rejected"]["not_finite"] = summary.unusable.not_finite;
  object["rejected"]["below_surface"] = summary.unusable.below_surface;
  object["stages"] = stages_json(summary.stages);
  object["rms"] = {{"single", summary.single.rms}, {"cluster", summary.cluster.rms}, {"projection", summary.projection.rms}};
  object["rms_by_channel"] = {{"single", summary.single.by_channel},
                              {"cluster", summary.cluster.by_channel},
                              {"projection", summary.projection.by_channel}};
  object["rms_by_material"] = {{"single", summary.single.by_material},
                               {"cluster", summary.cluster.by_material},
                               {"projection", summary.projection.by_material}};
  if (summary.pfa) {
    object["rms"]["pfa"] = summary.pfa->rms;
    object["rms_by_channel"]["pfa"] = summary.pfa->by_channel;
    object["rms_by_material"]["pfa"] = summary.pfa->by_material;
  }
  if (summary.normal) {
    object["rms"]["normal"] = summary.normal->rms;
    object["rms_by_channel"]["normal"] = summary.normal->by_channel;
    object["rms_by_material_on_fitted_normals"] = summary.normal->by_material;
  }
  object["normals"] = summary.normal ? "fitted" : "mesh";
  if (summary.normals_worth) {
    object["normals_worth"] = {{"deviance_gain", summary.normals_worth->gain},
                               {"deviance_gain_sigma", summary.normals_worth->gain_sigma},
                               {"left_out_samples", summary.normals_worth->samples}};
  }
  if (summary.normal_sigma_scale) object["normal_sigma_scale"] = *summary.normal_sigma_scale;
  if (summary.indirect) object["light_between_surfaces"] = indirect_json(*summary.indirect, options.interreflections.light);
  object["outliers"] = outliers_json(summary.outliers, session);
  object["outliers"]["error"] = outlier_error_json(summary.outlier_error);  // null: each material's own, in basis.json
  object["texels_by_material"] = summary.texels_by_material;
  object["prior"] = prior_json(summary.prior);
  return object.dump(2);
}

std::string fitted_session_key(const Model& model) { return json::parse(model.provenance_json).value("session_key", ""); }

LayoutOptions layout_of(const Model& model) {
  const json provenance = json::parse(model.provenance_json);
  const bool of_mesh = provenance.contains("layout") && provenance.at("layout").value("from", "") == "mesh";
  LayoutOptions layout;
  layout.choice = of_mesh ? LayoutChoice::Mesh : LayoutChoice::Photographs;
  layout.size = of_mesh ? model.width : 0;
  return layout;
}

}  // namespace lumitexel
