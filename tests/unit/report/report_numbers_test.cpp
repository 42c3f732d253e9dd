// Every number of the report's page comes from the JSON that goes with it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "processing/report/model_report.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using nlohmann::json;

Brdf glossy(double kd) {
  Brdf brdf = diffuse_brdf(kd, 1.3 * kd, 1.7 * kd);
  brdf.lobes.emplace_back();
  for (std::size_t c = 0; c < 3; ++c) brdf.lobes[0][c] = {0.2 + 0.1 * static_cast<double>(c), 3.1, kMirrorAim};
  return brdf;
}

// A model of which every section of the page has something to say.
Model talkative_model() {
  Model model = model_of(square_mesh(), 4, 4, glossy(0.11));
  model.materials.push_back({glossy(0.07), {glossy(0.07)}, {}});
  for (std::size_t t = 0; t < 16; t += 3) model.material[t] = 1;
  model.materials[0].sigma = BrdfSigma{{0.003, 0.004, 0.005}, {{LobeSigma{0.021, 0.032, 0.01}, LobeSigma{0.022, 0.033, 0.01}, LobeSigma{0.023, 0.034, 0.01}}}};
  model.before_normals = ReflectanceLayer{model.materials, model.material, model.weights, {}};
  model.normal_sigma = Image(4, 4, 1, 0.043f);
  model.indirect = Image(4, 4, 2);
  for (std::size_t t = 0; t < 16; ++t) {
    const double angle = t < 6 ? 0.0 : 0.17 + 0.01 * static_cast<double>(t);
    model.normal.data[3 * t] = static_cast<float>(std::sin(angle));
    model.normal.data[3 * t + 2] = static_cast<float>(std::cos(angle));
    model.samples.data[t] = static_cast<float>(2 + t);
    model.uncertainty.data[t] = static_cast<float>(0.021 + 0.013 * static_cast<double>(t));
    model.indirect.data[2 * t] = static_cast<float>(0.031 + 0.011 * static_cast<double>(t));
    model.indirect.data[2 * t + 1] = static_cast<float>(0.017 + 0.009 * static_cast<double>(t));
  }
  model.samples.data[5] = 0.0f;  // a part of the surface is not measured
  model.indirect_bounces = 3;
  model.provenance_json = R"({"session_key": "bench", "samples": 123457, "rms": {"single": 0.0987, "cluster": 0.0531, "projection": 0.0246, "normal": 0.0139},
    "rms_by_channel": {"single": [0.0911, 0.0922, 0.0933], "normal": [0.0131, 0.0142, 0.0153]}, "rms_by_material": {"cluster": [0.0537, 0.0411], "projection": [0.0243, 0.0311]},
    "rms_by_material_on_fitted_normals": [0.0177, 0.0188], "stages": [{"name": "materials", "seconds": 12.7, "peak_bytes": 104857600}, {"name": "normals", "seconds": 3.21, "peak_bytes": 134567890}],
    "choices": [{"fit": "on the mesh's normals", "of": "lobes", "over": "one", "candidate": "two", "gain": 0.0123, "gain_sigma": 0.0047, "taken": true}],
    "normals": "fitted", "normals_worth": {"deviance_gain": 0.237, "deviance_gain_sigma": 0.0677, "left_out_samples": 51008},
    "outliers": {"beyond_scales": 3.7, "samples": 4711, "by_view": {"a": {"dark": 23, "no highlight": 31, "dim": 47, "highlight": 53, "extra light": 61, "colour": 71}},
                 "count": {"dark": 27, "no highlight": 37, "dim": 43, "highlight": 59, "extra light": 67, "colour": 73}}})";
  return model;
}

struct Talkative {
  TemporaryFolder folder;
  Model model = talkative_model();
  CalibratedSession session;
  Evaluation evaluation;
  CalibrationSummary calibration;
  std::vector<PhotographExposure> exposures;
  std::vector<KnownMaterial> known;

  explicit Talkative(bool imported) {
    session.key = "bench";
    session.mesh = model.mesh;
    for (const char* name : {"a", "b", "c"}) add_view(name);
    calibration.scale_sigma = 0.0123;
    calibration.shares = {{"scale", "the card", 0.613}, {"scale", "the lamp", 0.387}};
    if (imported) {
      calibration.rim_offset_px = 0.123;
      calibration.rim_offset_sigma_px = 0.0456;
    } else {
      calibration.intensity = {1.7, 2.7, 3.7};
      calibration.lamp.factor = {1.013, 0.987, 1.029};
      calibration.lamp.factor_sigma = {0.0031, 0.0042, 0.0053};
      calibration.stray_lights = {{.views = {"a", "b"}, .position_in_rig = {0.31, 0.47, 0.59}, .sigma_m = 0.0071, .card_share = 0.083, .card_share_sigma = 0.0091}};
    }
    NoProgress progress;
    evaluation = evaluate_model(model, session, progress);
    const Brdf own = glossy(0.09);
    known = {{"chalk", [own](const LobeGeometry& g) { return evaluate(own, g); }}, {"slate", [](const LobeGeometry&) { return ChannelValues{0.05, 0.05, 0.05}; }}};
  }

  void add_view(const std::string& name) {
    View view = view_from_above(24, 3.0);
    view.name = name;
    view.heldout = name != "a";
    view.photograph = folder / (name + ".exr");
    const float level = 0.1f + 0.013f * static_cast<float>(session.views.size());
    RadianceImage photograph{Image(24, 24, 3, level), Image(24, 24, 3), std::vector<std::uint8_t>(24 * 24, 0)};
    for (std::size_t i = 0; i < photograph.radiance.data.size(); i += 7) photograph.radiance.data[i] *= 1.31f;
    write_radiance_image(view.photograph, photograph);
    const double step = 1.0 + 0.07 * static_cast<double>(session.views.size());
    calibration.poses.push_back({name, "silhouette", 0.00012 * step, 0.034 * step, 0.57 * step, 4, "silhouette", 0.91 * step, 13.3 * step});
    calibration.lights.push_back({.view = name, .sigma_m = 0.00081 * step, .from_spheres = true, .highlights = 5});
    exposures.push_back({name, view.heldout, {0.003 * step, 0.024, 0.197}, 0.0123 * step, 0.456 * step, {0.01, 0.02, 0.04, 0.08, 0.16}});
    session.views.push_back(view);
  }

  ReportSubject subject() const {
    ReportSubject subject{"bird", model, &session, &evaluation, &calibration, exposures};
    subject.known = known;
    return subject;
  }
};

// Every number another one: integers stay whole, shares stay shares.
void change_numbers(json& data) {
  if (data.is_structured()) {
    for (json& item : data) change_numbers(item);
  } else if (data.is_number_integer()) {
    data = 2 * data.get<std::int64_t>() + 1001;
  } else if (data.is_number()) {
    data = 0.77 * data.get<double>() + 0.0013;
  }
}

// Without what lies between `open` and the `close` after it. By hand: a regular expression would run out of stack over a picture's characters.
std::string without(const std::string& html, const std::string& open, const std::string& close) {
  std::string kept;
  std::size_t at = 0;
  for (std::size_t from = html.find(open); from != std::string::npos; from = html.find(open, at)) {
    kept += html.substr(at, from - at) + "\n";
    const std::size_t end = html.find(close, from);
    if (end == std::string::npos) return kept;
    at = end + close.size();
  }
  return kept + html.substr(at);
}

// What a reader sees, but for drawings, headings and names of rows: tags are gone; each cell, caption, sentence, tile or lobe is a line.
std::vector<std::string> lines_of(const std::string& html) {
  std::string text = html.substr(html.find("<body"));
  const std::pair<const char*, const char*> unseen[] = {{"<script", "</script>"}, {"<style", "</style>"}, {"<svg", "</svg>"}, {"<h1", "</h1>"}, {"<h2", "</h2>"},
                                                        {"<h3", "</h3>"}, {"<th>", "</th>"}, {"<tr><td>", "</td>"}, {"<", ">"}};
  for (const auto& [open, close] : unseen) text = without(text, open, close);
  for (std::size_t at = 0; (at = text.find("; ", at)) != std::string::npos;) {
    const std::size_t line = text.rfind('\n', at) + 1;
    if (text.compare(line, 9, "Material ") == 0 || text.compare(line, 5, "lobe:") == 0) text.replace(at, 2, "\nlobe:");
    ++at;
  }
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (line.find_first_of("0123456789") != std::string::npos) lines.push_back(line);
  }
  return lines;
}

// Numbers that the page's words hold: what figures mean, where a scale ends. Anything else has to change with the JSON.
bool is_said_in_words(const std::string& line) {
  static const std::regex kWords(
      "0 %|0°|.*and more|.*[0-9]th percentile.*|.*of white|.*Lensch et al.*|.*an ideal white surface.*|.*Other lobes, functions.*|.*almost exactly below.*"
      "|.*with six degrees of freedom.*|.*spheres begin to look different.*|.*WebGL 2.*|brighter by 30 %|1-RMS",
      std::regex::icase);
  return std::regex_match(line, kWords);
}

void expect_numbers_of_the_json(const Talkative& talkative, std::size_t fewest) {
  NoProgress progress;
  const ReportSubject subject = talkative.subject();
  json data = json::parse(report_json(subject));
  const std::vector<std::string> lines = lines_of(model_report(subject, data.dump(), progress));
  change_numbers(data);
  const std::vector<std::string> changed = lines_of(model_report(subject, data.dump(), progress));
  ASSERT_EQ(lines.size(), changed.size());
  std::size_t compared = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (is_said_in_words(lines[i])) continue;
    ++compared;
    EXPECT_NE(lines[i], changed[i]) << "does not come from the JSON";
  }
  EXPECT_GT(compared, fewest);
}

TEST(ReportNumbers, AllComeFromTheJson) { expect_numbers_of_the_json(Talkative(false), 100); }
TEST(ReportNumbers, AllComeFromTheJsonOfAnImportedSession) { expect_numbers_of_the_json(Talkative(true), 100); }

}  // namespace
}  // namespace lumitexel
