// The report's sections, each as markup.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "processing/model/render_view.h"
#include "processing/report/model_report.h"

namespace lumitexel {

// For each material, how many texels are of it and were fitted to samples; filled-in ones do not count.
std::vector<std::int64_t> texels_by_material(const Model& model);

// ---- numbers (report_tables.cpp)
std::string headline(const ReportSubject& subject, const nlohmann::json& provenance);
std::string sample_error_section(const nlohmann::json& provenance);  // the paper's Table II
std::string photograph_error_section(const Evaluation& evaluation);
std::string outlier_section(const nlohmann::json& provenance);  // empty for a model that was not looked through
std::string timing_section(const nlohmann::json& provenance);
std::string definitions_section();

// ---- pictures (report_pictures.cpp)
std::string comparison_section(const ReportSubject& subject, const ViewRenderer& renderer, Progress& progress);
std::string material_section(const ReportSubject& subject, const ViewRenderer& renderer);
std::string setup_section(const CalibratedSession& session);

}  // namespace lumitexel
