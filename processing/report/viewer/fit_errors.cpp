#include "processing/report/viewer/fit_errors.h"

#include <nlohmann/json.hpp>

namespace lumitexel {
namespace {

using nlohmann::json;

// Of models of before errors were kept: the one that the fit's options gave to every material.
std::optional<FitErrors> given_errors(const json& provenance, std::size_t materials) {
  const json options = provenance.value("options", json::object());
  if (options.value("method", "") != "lumitexel" || provenance.value("errors", json()) != "given") return std::nullopt;
  const std::vector<ErrorModel> errors(materials, ErrorModel(options.at("relative_error").get<double>(), options.at("error_floor").get<double>()));
  return FitErrors{errors, errors};
}

}  // namespace

std::optional<FitErrors> errors_of_fit(const Model& model) {
  const json provenance = json::parse(model.provenance_json);
  FitErrors errors;
  for (const ModelMaterial& material : model.materials) {
    if (!material.error) return given_errors(provenance, model.materials.size());
    errors.weights.push_back(*material.error);
  }
  const json of_outliers = provenance.value("outliers", json::object()).value("error", json());
  errors.residuals = errors.weights;
  if (of_outliers.is_object()) {
    errors.residuals.assign(errors.weights.size(), ErrorModel(of_outliers.at("relative").get<double>(), of_outliers.at("floor").get<double>()));
  }
  return errors;
}

}  // namespace lumitexel
