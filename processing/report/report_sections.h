// The report's sections, each as markup. Numbers that a section shows it takes from the JSON that it is given, a part of report_json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "processing/model/render_view.h"
#include "processing/report/model_report.h"

namespace lumitexel {

// For each material, how many texels are of it and were fitted to samples; filled-in ones do not count.
std::vector<std::int64_t> texels_by_material(const Model& model);

// NaN where there is no such number, or null.
double number_or_nan(const nlohmann::json& parent, const std::string& key);

// ---- what a reader takes along who reads no further (report_summary.cpp)
// {"materials", "share_of_surface_measured", "texels_measured", "samples", "fit_seconds", "prediction": {"kept_out_of_the_fit", "photographs",
// "square_roots", "clipped", "psnr_db", "in_words", "shown": the photograph}}; the prediction is null where nothing was compared.
nlohmann::json summary_json(const ReportSubject& subject);
std::string headline(const ReportSubject& subject, const nlohmann::json& summary);
// The photograph of median error beside its re-rendering. The subject has a session and an evaluation.
std::string typical_comparison(const ReportSubject& subject, const nlohmann::json& evaluation, const ViewRenderer& renderer);

// ---- numbers (report_tables.cpp)
// The paper's Table II with the errors of photographs: a list of {"stage", "title", "papers_name", "rms", "share_of_single", "heldout" and
// "fit": {"clipped", "square_roots"} or null}; the stages that ran.
nlohmann::json stages_json(const nlohmann::json& provenance, const Evaluation* evaluation);
std::string stage_section(const nlohmann::json& stages, const nlohmann::json& provenance);
std::string photograph_error_section(const nlohmann::json& evaluation);  // of evaluation_json
std::string outlier_section(const nlohmann::json& provenance);  // empty for a model that was not looked through
std::string timing_section(const nlohmann::json& provenance);
std::string definitions_section();

// ---- what left-out samples said of alternatives (report_choices.cpp)
std::string choice_section(const nlohmann::json& provenance);  // empty where nothing was asked

// ---- pictures (report_pictures.cpp)
// A list of {"photograph", "white": the radiance that its picture shows as white}, of the photographs that are shown. The subject has a session.
nlohmann::json shown_json(const ReportSubject& subject, const ViewRenderer& renderer);
std::string comparison_section(const ReportSubject& subject, const nlohmann::json& whites, const nlohmann::json& evaluation, const ViewRenderer& renderer,
                               Progress& progress);
View map_view(const ReportSubject& subject);  // as the first photograph shown sees the object, filling the picture

// ---- materials (report_materials.cpp)
// A list of {"share_of_measured_texels", "family", "diffuse_albedo" and its "sigma": lists by channel, "lobes": [{"strength" (peak in 1/sr, F0 or albedo),
// "strength_sigma", "shape" (exponent or alpha), "shape_sigma": lists by channel}]}. Sigmas are relative, null where nothing is known of them.
nlohmann::json materials_json(const Model& model);
std::string material_section(const ReportSubject& subject, const nlohmann::json& materials, const ViewRenderer& renderer);

// ---- how it was photographed (report_setup.cpp)
// What the drawings show: a list of {"photograph", "heldout", "camera_m", "light": {"point", "vector": where it stands, m, or towards it}}, in the world.
nlohmann::json setup_json(const CalibratedSession& session);
std::string setup_section(const CalibratedSession& session);
// A list a photograph; null where a session does not know.
nlohmann::json exposures_json(const std::vector<PhotographExposure>& exposures);
std::string exposure_section(const std::vector<PhotographExposure>& exposures, const nlohmann::json& data);  // empty of none
std::string calibration_section(const nlohmann::json& summary);  // of calibration_summary_json.h

// ---- coverage and uncertainty (report_maps.cpp)
// {"texels", "texels_measured", "samples_a_texel": {"tenth", "median", "most"}, "relative_sigma": {"median", "nine_tenths"}}, over the texels
// that were fitted to samples; null where there are none. "texels" have a material, the filled-in margin of the patches included.
nlohmann::json coverage_json(const Model& model);
std::string coverage_section(const nlohmann::json& coverage, const ViewRenderer& renderer, const View& view);

// ---- what it comes from (report_doubt.cpp)
// {"points": asked, "shares": {"normal", "no highlight", "few samples", "scatter"}, "by_material": the same a material}; null without a session.
nlohmann::json doubt_json(const ReportSubject& subject);
std::string doubt_section(const ReportSubject& subject, const nlohmann::json& doubt, const View& view);

// ---- fitted normals (report_normals.cpp)
// {"texels_measured", "texels_on_the_meshs_normal", "within_deg", "tilt_against_mesh_deg" and "sigma_deg": {"median", "nine_tenths", "most"}}
// over the texels that were fitted to samples; null of a model without fitted normals.
nlohmann::json normals_json(const Model& model);
std::string normals_section(const ReportSubject& subject, const nlohmann::json& normals, const ViewRenderer& renderer, const View& view);

// ---- light between surfaces (report_indirect.cpp)
// {"bounces", "estimated_most" (beside a lamp's light) and "found_share" (of the samples): {"median", "nine_tenths", "most"}} over the texels that
// were fitted to samples; null of a model that nobody looked for it in.
nlohmann::json indirect_json(const Model& model);
std::string indirect_section(const ReportSubject& subject, const nlohmann::json& data, const View& view);

// ---- known materials (report_nearest.cpp)
nlohmann::json nearest_json(const ReportSubject& subject);  // a list a material, the three nearest: {"name", "distance"}
// known: of how many. Empty where none is known.
std::string nearest_section(const ReportSubject& subject, const nlohmann::json& nearest, const nlohmann::json& known);

}  // namespace lumitexel
