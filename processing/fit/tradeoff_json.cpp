#include "processing/fit/tradeoff_json.h"

#include <cmath>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

using Json = nlohmann::ordered_json;

namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double number_or_nan(const Json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

Json to_json(const ErrorWithSpread& error) {
  return {{"value", finite_or_null(error.value)}, {"sigma", finite_or_null(error.sigma)}, {"draw_deviation", finite_or_null(error.draw_deviation)}};
}

Json to_json(const HeldoutError& error) {
  Json views = Json::array();
  for (const double of_view : error.by_view) views.push_back(finite_or_null(of_view));
  return {{"pooled", finite_or_null(error.pooled)}, {"by_view", views}};
}

HeldoutError error_from(const Json& json) {
  HeldoutError error{number_or_nan(json.at("pooled")), {}};
  for (const Json& of_view : json.at("by_view")) error.by_view.push_back(number_or_nan(of_view));
  return error;
}

Json bytes_json(const std::optional<std::int64_t>& bytes) { return bytes ? Json(*bytes) : Json(nullptr); }

// All draws together, then each.
Json measurement_json(const TradeoffMeasurement& measurement) {
  Json draws = Json::array();
  for (const TradeoffRun& run : measurement.runs) draws.push_back(run_json(run));
  const auto [least, most] = materials_found(measurement);
  return {{"materials", {{"least", least}, {"most", most}}},
          {"fit_views", measurement.runs.front().fit_views},
          {"seconds", measurement.seconds},
          {"cpu_seconds", measurement.cpu_seconds},
          {"peak_bytes", bytes_json(measurement.peak_bytes)},
          {"heldout",
           {{"relative_rms", to_json(measurement.relative)},
            {"clipped_rms", to_json(measurement.clipped)},
            {"sqrt_rms", to_json(measurement.square_root)}}},
          {"draws", draws}};
}

Json gain_json(const std::optional<TradeoffGain>& gain) {
  if (!gain) return nullptr;
  return {{"gain", to_json(gain->gain)}, {"more_cpu_seconds", gain->more_cpu_seconds}, {"gain_per_cpu_second", finite_or_null(gain->per_second)}};
}

}  // namespace

Json setting_json(const TradeoffSetting& setting) {
  const FitOptions& options = setting.options;
  return {{"name", setting.name},
          {"quality", options.quality},
          {"method", options.method == FitMethod::Paper ? "paper" : "lumitexel"},
          {"family", options.family ? to_string(*options.family) : "auto"},
          {"lobe_shapes", to_string(options.lobe_shapes)},
          {"normals", to_string(options.normals)},
          {"interreflections", to_string(options.interreflections.choice)},
          {"interreflection_rounds", options.interreflections.rounds},
          {"errors", to_string(options.errors)},
          {"most_lobes", options.most_lobes},
          {"principal_functions", options.principal_functions},
          {"bases", options.bases == 0 ? Json("auto") : Json(options.bases)},
          {"precision", to_string(options.precision)},
          {"materials", options.materials},
          {"views", setting.fit_views == 0 ? Json("all") : Json(setting.fit_views)},
          {"pixel_block", setting.pixel_block},
          {"plain_projection", options.plain_projection},
          {"intensity_weight", options.intensity_weight},
          {"relative_error", options.relative_error},
          {"error_floor_share", options.error_floor_share},
          {"learning_lumitexels", options.learning_lumitexels},
          {"draw", options.draw},
          {"final_lumitexels", options.final_lumitexels}};
}

Json run_json(const TradeoffRun& run) {
  return {{"materials", run.materials},
          {"fit_views", run.fit_views},
          {"seconds", run.seconds},
          {"cpu_seconds", run.cpu_seconds},
          {"peak_bytes", bytes_json(run.peak_bytes)},
          {"heldout", {{"relative_rms", to_json(run.relative)}, {"clipped_rms", to_json(run.clipped)}, {"sqrt_rms", to_json(run.square_root)}}}};
}

TradeoffRun run_from(const Json& json) {
  TradeoffRun run;
  run.materials = json.at("materials").get<std::size_t>();
  run.fit_views = json.at("fit_views").get<std::size_t>();
  run.seconds = json.at("seconds").get<double>();
  run.cpu_seconds = json.at("cpu_seconds").get<double>();
  if (!json.at("peak_bytes").is_null()) run.peak_bytes = json.at("peak_bytes").get<std::int64_t>();
  const Json& heldout = json.at("heldout");
  run.relative = error_from(heldout.at("relative_rms"));
  run.clipped = error_from(heldout.at("clipped_rms"));
  run.square_root = error_from(heldout.at("sqrt_rms"));
  return run;
}

std::string tradeoff_json(const Tradeoff& tradeoff) {
  const std::vector<bool> front = pareto_front(tradeoff.measurements);
  Json settings = Json::array();
  for (std::size_t i = 0; i < front.size(); ++i) {
    const TradeoffMeasurement& measurement = tradeoff.measurements[i];
    Json entry = {{"name", measurement.setting.name}, {"what", measurement.setting.what}, {"options", setting_json(measurement.setting)}};
    entry["options"].erase("draw");  // the k-th of "draws" is draw k
    entry["failure"] = measurement.measured() ? Json(nullptr) : Json(measurement.failure);
    entry["measured"] = measurement.measured() ? measurement_json(measurement) : Json(nullptr);
    entry["pareto_front"] = static_cast<bool>(front[i]);
    entry["against_standard"] = gain_json(gain_over_standard(tradeoff, measurement));
    settings.push_back(entry);
  }
  const Json document = {{"session_key", tradeoff.session_key},
                         {"fit_views", tradeoff.fit_views},
                         {"heldout_views", tradeoff.heldout_views},
                         {"draws", tradeoff.draws},
                         {"fits_known_before", tradeoff.known_before},
                         {"settings", settings}};
  return document.dump(2);
}

}  // namespace lumitexel
