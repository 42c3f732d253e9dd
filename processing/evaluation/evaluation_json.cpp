#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/stage_caution.h"

namespace lumitexel {
namespace {

using Json = nlohmann::ordered_json;

// The names that the format has for every stage of the full chain, also those that this model cannot have run.
constexpr const char* kStageNames[] = {"single", "cluster", "projection", "pfa", "normal"};

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const ImageError& error) {
  return {{"relative_rms", finite_or_null(error.relative_rms)},
          {"clipped_rms", finite_or_null(error.clipped_rms)},
          {"sqrt_rms", finite_or_null(error.sqrt_rms)},
          {"psnr_db", finite_or_null(error.psnr_db)}};
}

Json to_json(const ErrorByStage& errors) {
  Json stages = Json::object();
  for (std::size_t i = 0; i < std::size(kStageNames); ++i) {
    const bool ran = i < errors.size() && errors[i].has_value();
    stages[kStageNames[i]] = ran ? to_json(*errors[i]) : Json(nullptr);
  }
  return stages;
}

Json to_json(const std::vector<StageCaution>& cautions) {
  Json list = Json::array();
  for (const StageCaution& caution : cautions) {
    list.push_back({{"measure", caution.measure}, {"last", caution.last}, {"before", caution.before}, {"better_stage", to_string(caution.better)}});
  }
  return list;
}

Json sample_rms(const Json& provenance) {
  const Json given = provenance.value("rms", Json::object());
  Json rms = Json::object();
  for (const char* stage : kStageNames) rms[stage] = given.contains(stage) ? given.at(stage) : Json(nullptr);
  return rms;
}

}  // namespace

std::string evaluation_json(const Evaluation& evaluation) {
  const Json provenance = Json::parse(evaluation.provenance_json);
  const auto last = static_cast<std::size_t>(evaluation.last_stage);
  Json views = Json::array();
  for (const ViewEvaluation& view : evaluation.views) {
    Json entry = {
        {"image", view.image}, {"split", view.heldout ? "heldout" : "fit"}, {"object_pixels", view.object_pixels}};
    entry.update(to_json(view.error));
    views.push_back(entry);
  }
  const Json document = {{"rms", sample_rms(provenance)},
                         {"fit", to_json(evaluation.fit[last].value_or(ImageError{}))},
                         {"heldout", to_json(evaluation.heldout[last].value_or(ImageError{}))},
                         {"heldout_by_stage", to_json(evaluation.heldout)},
                         {"heldout_measured_by_stage", to_json(evaluation.heldout_measured)},
                         {"heldout_measured_share", finite_or_null(evaluation.heldout_measured_share)},
                         {"heldout_better_before_last_stage", to_json(stage_cautions(evaluation))},
                         {"fit_by_stage", to_json(evaluation.fit)},
                         {"views", views},
                         {"rms_by_channel", provenance.value("rms_by_channel", Json())},
                         {"rms_by_material", provenance.value("rms_by_material", Json())},
                         {"stage", to_string(evaluation.last_stage)},
                         {"session_key", evaluation.session_key},
                         {"same_session", evaluation.same_session}};
  return document.dump(2);
}

}  // namespace lumitexel
