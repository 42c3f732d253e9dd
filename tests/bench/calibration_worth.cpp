// What each step of the calibration buys: a simulated session is calibrated with all steps, with each one left out, with none, and by the
// truth; each time a model is fitted (same_materials.h) and asked for photographs that the fit did not see. Again and again with other
// seeds, so that what a step buys has a standard error: its errors are held against those of the same session with all steps.
//
// Two judges. "truth": the model seen by the true camera from the true pose under the true light, against the noise-free radiance; what a
// model is for. Beside it, how far its pictures are from those of a model that was fitted by the truth: what calibration alone does to
// them, without what any such model gets wrong. "own": as the session's own calibration has camera, pose and light, against its own
// photographs; all that a real session can ask, and blind to what calibration got wrong in the same way in all its views. So is it to a
// wrong lens: poses registered under it put the mesh where it is in the picture. "Without lens" is without lamp_pattern as well, which needs
// the boards' places. With --scale, the simulation's errors in pixels (lens_principal_error_px) want scaling by hand: --simulation.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "drivers/error.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/predicted_view.h"
#include "processing/fit/fit_model.h"
#include "tests/bench/machine.h"
#include "tests/unit/worth/relighting_error.h"
#include "tests/unit/worth/same_materials.h"
#include "tests/unit/worth/simulated_capture.h"
#include "tests/unit/worth/true_views.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

struct Options {
  SimulatedCapture capture;
  FitOptions fit;
  std::vector<CalibrationStep> steps;
  bool search_anew = false;    // each fit as fit_model does it
  int seeds = 3, first_seed = 1, unseen = 12;
};

struct Judged {
  RelightingError truth, own;
  RelightingError astray;  // of the unseen views' pictures against those of the model fitted by the truth
  double picture_px = 0;  // rms distance, over views and vertices, of where the calibration has the mesh in the picture from where it is
  double light_mm = 0, irradiance = 0;  // of the lights, rms; of the irradiance at the mesh's middle, relative, rms
};

struct Variant {
  std::string name;
  CalibrationOptions steps;
  bool truth = false;
  std::vector<Judged> judged{};  // one a seed
};

std::vector<Image> pictures_of(const Model& model, const std::vector<TrueView>& views) {
  const ViewRenderer renderer(model);
  std::vector<Image> pictures;
  for (const TrueView& view : views) pictures.push_back(predicted_view(renderer, view.view, last_stage(model)).radiance);
  return pictures;
}

RelightingError judged_by_itself(const Model& model, const CalibratedSession& session) {
  const ViewRenderer renderer(model);
  RelightingSums sums;
  for (const View& view : session.views) {
    if (!view.heldout) continue;
    const RadianceImage photograph = read_photograph(view, model.channels);
    const RenderedView rendered = predicted_view(renderer, view, last_stage(model));
    sums.add(rendered.radiance, photograph.radiance, object_pixels(photograph, rendered.hit));
  }
  return sums.error();
}

void note_calibration(const CalibratedSession& session, const std::vector<View>& as_it_was, Judged& judged) {
  double picture = 0.0, light = 0.0, irradiance = 0.0;
  const auto views = static_cast<double>(session.views.size());
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    const View &truth = as_it_was[v], &found = session.views[v];
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& x : session.mesh.positions) {
      const double share = 1.0 / static_cast<double>(session.mesh.positions.size());
      picture += share / views *
                 (found.camera.project(found.camera_from_world * x) - truth.camera.project(truth.camera_from_world * x)).squaredNorm();
      middle += share * x;
    }
    light += (found.light.vector_in_world - truth.light.vector_in_world).squaredNorm() / views;
    irradiance += std::pow(found.light.irradiance(middle, 1) / truth.light.irradiance(middle, 1) - 1.0, 2) / views;
  }
  judged.picture_px = std::sqrt(picture);
  judged.light_mm = 1e3 * std::sqrt(light);
  judged.irradiance = std::sqrt(irradiance);
}

// Of one seed: what all its variants share.
struct Trial {
  const CapturedWorld& captured;
  const std::vector<View>& as_it_was;
  const std::vector<TrueView>& unseen;
  const SameMaterials* materials;    // none: each fit searches anew
  std::vector<Image> by_the_truth{};  // the unseen views as a model fitted by the truth predicts them
};

Model fit(const Trial& trial, const CalibratedSession& session, const FitOptions& options) {
  NoProgress quiet;
  return trial.materials ? trial.materials->fit(session) : fit_model(session, options, StageTimer(), quiet).model;
}

void judge_by_truth(const Trial& trial, const Model& model, Judged& judged) {
  const std::vector<Image> pictures = pictures_of(model, trial.unseen);
  RelightingSums truth, astray;
  for (std::size_t v = 0; v < pictures.size(); ++v) {
    truth.add(pictures[v], trial.unseen[v].radiance, trial.unseen[v].counted);
    astray.add(pictures[v], trial.by_the_truth[v], trial.unseen[v].counted);
  }
  judged.truth = truth.error();
  judged.astray = astray.error();
}

Judged judge(const Trial& trial, const Variant& variant, const FitOptions& options) {
  NoProgress quiet;
  CalibratedSession session = calibrate_session(trial.captured.session, quiet, nullptr, variant.steps);
  if (variant.truth) take_truth(session, trial.as_it_was);
  const Model model = fit(trial, session, options);
  Judged judged;
  judge_by_truth(trial, model, judged);
  judged.own = judged_by_itself(model, session);
  note_calibration(session, trial.as_it_was, judged);
  return judged;
}

struct Mean {
  double mean = 0, error = 0;  // its standard error; 0 of one value
};

Mean mean_of(const std::vector<Judged>& judged, const std::function<double(std::size_t)>& value) {
  const auto n = static_cast<double>(judged.size());
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < judged.size(); ++i) mean += value(i) / n;
  for (std::size_t i = 0; i < judged.size(); ++i) squares += std::pow(value(i) - mean, 2);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1.0) / n) : 0.0};
}

using Read = std::function<double(const Judged&)>;

struct Column {
  const char* name;
  Read read;
};

// The first row as it is; of the others the difference from it, seed by seed.
void print_judge(const char* title, const std::vector<Variant>& variants, const std::vector<Column>& columns) {
  std::printf("\n%s\n| calibrated |", title);
  for (const Column& column : columns) std::printf(" %s |", column.name);
  std::printf("\n| --- |");
  for (std::size_t c = 0; c < columns.size(); ++c) std::printf(" --- |");
  const std::vector<Judged>& all = variants.front().judged;
  for (const Variant& variant : variants) {
    const bool first = &variant == &variants.front();
    std::printf("\n| %s |", variant.name.c_str());
    for (const auto& [name, read] : columns) {
      const Mean value = mean_of(all, [&](std::size_t i) { return read(variant.judged[i]) - (first ? 0.0 : read(all[i])); });
      std::printf(first ? " %.4f ± %.4f |" : " %+.4f ± %.4f |", value.mean, value.error);
    }
  }
  std::printf("\n");
}

void print_tables(const std::vector<Variant>& variants) {
  const std::size_t seeds = variants.front().judged.size();
  std::printf("\n%zu seeds; mean and standard error; below the first row: the difference from it, seed by seed\n", seeds);
  print_judge("judged under the true camera, pose and light", variants,
              {{"clipped rms", [](const Judged& j) { return j.truth.clipped; }},
               {"square roots", [](const Judged& j) { return j.truth.roots; }},
               {"level, off by", [](const Judged& j) { return std::abs(j.truth.level); }},
               {"from the truth's model", [](const Judged& j) { return j.astray.clipped; }},
               {"level from its", [](const Judged& j) { return std::abs(j.astray.level); }}});
  print_judge("judged under the session's own", variants,
              {{"clipped rms", [](const Judged& j) { return j.own.clipped; }},
               {"square roots", [](const Judged& j) { return j.own.roots; }},
               {"level, off by", [](const Judged& j) { return std::abs(j.own.level); }}});
  std::printf("\nwhat the calibration itself is off, rms\n| calibrated | mesh in the picture, px | lights, mm | irradiance, %% |\n| --- | --- | --- | --- |\n");
  for (const Variant& variant : variants) {
    const auto mean = [&](const Read& read) { return mean_of(variant.judged, [&](std::size_t i) { return read(variant.judged[i]); }).mean; };
    std::printf("| %s | %.2f | %.2f | %.2f |\n", variant.name.c_str(), mean([](const Judged& j) { return j.picture_px; }),
                mean([](const Judged& j) { return j.light_mm; }), mean([](const Judged& j) { return 100.0 * j.irradiance; }));
  }
  std::fflush(stdout);
}

int run(const Options& options) {
  std::vector<Variant> variants{{"with everything", {}}};
  for (const CalibrationStep step : options.steps) variants.push_back({std::string("without ") + to_string(step), {{step}}});
  const auto& every = all_calibration_steps();
  variants.push_back({"without any", {{every.begin(), every.end()}}});
  variants.push_back({"by the truth", {}, true});
  std::printf("%s\n%s, %s, pictures x %g; %s quality, %d materials, %s\n", machine_line().c_str(), options.capture.rig.c_str(),
              options.capture.plan.c_str(), options.capture.scale, options.fit.quality.c_str(), options.fit.materials,
              options.search_anew ? "sought anew by each fit" : "sought once a seed");
  std::fflush(stdout);
  for (int s = 0; s < options.seeds; ++s) {
    const TemporaryFolder folder;
    const CapturedWorld captured = capture_simulated(options.capture, options.first_seed + s, folder.path());
    const std::vector<TrueView> unseen = see_truly(captured.world, spread_views(options.unseen));
    const std::vector<View> as_it_was = session_as_it_was(captured);
    NoProgress quiet;
    CalibratedSession truth = calibrate_session(captured.session, quiet);
    take_truth(truth, as_it_was);
    std::optional<SameMaterials> materials;
    if (!options.search_anew) materials.emplace(truth, options.fit);
    Trial trial{captured, as_it_was, unseen, materials ? &*materials : nullptr};
    trial.by_the_truth = pictures_of(fit(trial, truth, options.fit), unseen);
    for (Variant& variant : variants) variant.judged.push_back(judge(trial, variant, options.fit));
    print_tables(variants);
  }
  return 0;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Held-out relighting error with and without each step of the calibration, over seeds of a simulated rig");
  Options options;
  std::string quality = "draft";
  int materials = 4;
  std::vector<std::string> only, simulation;
  options.capture.scale = 0.5;
  app.add_option("RIG", options.capture.rig, "A simulated rig")->required();
  app.add_option("PLAN", options.capture.plan, "A capture plan with held-out views")->required();
  app.add_option("--seeds", options.seeds, "Sessions")->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "The others follow")->capture_default_str();
  app.add_option("--unseen", options.unseen, "Views, spread over turntable and light, for the truth's judgement")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--scale", options.capture.scale, "Of the picture's sides")->check(CLI::Range(0.2, 4.0))->capture_default_str();
  app.add_option("--simulation", simulation, "KEY = VALUE of the rig's [simulation] table");
  app.add_option("--quality", quality, "Of the fit: draft, standard or reference")->capture_default_str();
  app.add_option("--materials", materials, "Materials to fit")->capture_default_str();
  app.add_flag("--search-anew", options.search_anew, "Each fit makes its own choices: what a user sees, the search's chance included");
  app.add_option("--only", only, "These steps and no others are left out, one at a time")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  options.fit = FitOptions::preset(quality);
  options.fit.materials = materials;
  options.fit.normals = NormalChoice::Mesh;
  options.fit.interreflections.choice = InterreflectionChoice::Off;  // the simulated rig has no light between surfaces
  for (const std::string& line : simulation) options.capture.simulation_toml += line + '\n';
  for (const std::string& name : only) options.steps.push_back(calibration_step_from_string(name));
  if (only.empty()) options.steps = all_calibration_steps();
  return run(options);
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  try {
    return lumitexel::parse_and_run(argc, argv);
  } catch (const lumitexel::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
