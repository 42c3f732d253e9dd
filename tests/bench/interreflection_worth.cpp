// What it is worth to take light between surfaces out of the samples: held-out error by how much of itself the object faces, for a fit that
// does not, for that fit rendered with bounces all the same, and for one that does.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/predicted_view.h"
#include "processing/fit/fit_model.h"
#include "processing/interreflection/form_factors.h"
#include "rig/session_store.h"
#include "tests/bench/fit_settings.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

// Form factors: open, in between, concave.
constexpr std::array<double, 4> kEdges = {0.0, 0.05, 0.2, 1.01};
using Groups = std::array<ErrorSums, 4>;  // and all

std::vector<float> self_facing(const Model& model) {
  return facing(model.mesh, RayScene(model.mesh), std::vector<float>(model.mesh.triangles.size(), 1.0f));
}

double between_corners(const std::vector<float>& at_vertex, const Mesh& mesh, const TexturedPoint& point) {
  const auto& corner = mesh.triangles[point.triangle];
  return (1.0 - point.u - point.v) * static_cast<double>(at_vertex[corner[0]]) + point.u * static_cast<double>(at_vertex[corner[1]]) +
         point.v * static_cast<double>(at_vertex[corner[2]]);
}

void add_view(const Model& model, const View& view, const std::vector<float>& factor, FitStage stage, Groups& groups) {
  const RadianceImage photograph = read_photograph(view, model.channels);
  const RenderedView predicted = predicted_view(ViewRenderer(model), view, stage, 32);
  const std::vector<std::uint8_t> counted = object_pixels(photograph, predicted.hit);
  groups[3].add(predicted.radiance, photograph.radiance, counted);
  const ModelSurface surface(model);
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  std::array<std::vector<std::uint8_t>, 3> of_group;
  of_group.fill(std::vector<std::uint8_t>(counted.size(), 0));
  for (int y = 0; y < view.camera.height_px; ++y) {
    for (int x = 0; x < view.camera.width_px; ++x) {
      const auto pixel = static_cast<std::size_t>(y * view.camera.width_px + x);
      if (counted[pixel] == 0) continue;
      const auto point = surface.trace(world_from_camera.translation(), world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5}));
      if (!point) continue;
      const double share = between_corners(factor, model.mesh, *point);
      for (std::size_t g = 0; g < 3; ++g) of_group[g][pixel] = share >= kEdges[g] && share < kEdges[g + 1];
    }
  }
  for (std::size_t g = 0; g < 3; ++g) groups[g].add(predicted.radiance, photograph.radiance, of_group[g]);
}

void print(const char* title, const CalibratedSession& session, const Model& model) {
  const std::vector<float> factor = self_facing(model);
  Groups groups;
  for (const View& view : session.views) {
    if (view.heldout) add_view(model, view, factor, last_stage(model), groups);
  }
  std::printf("%-28s", title);
  for (const ErrorSums& group : groups) {
    const ImageError error = group.error();
    std::printf("   %.3f %.3f %.3f", error.relative_rms, error.clipped_rms, error.sqrt_rms);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Held-out error with and without light between surfaces, by how concave the surface is");
  lumitexel::FitSettings settings;
  int bounces = 2;
  settings.ask_for(app);
  app.add_option("--bounces", bounces, "Between surfaces")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  using namespace lumitexel;
  NoProgress quiet;
  const CalibratedSession session = calibrate_session(SessionStore::open(settings.session, OpenMode::ReadOnly), quiet);
  FitOptions options = settings.options();
  options.interreflections.light.bounces = bounces;
  options.interreflections.choice = InterreflectionChoice::Always;  // the question is what it does
  std::printf("%s\n%s, %s quality, %d materials, %d lobes; held-out photographs, relative / clipped / roots\n", machine_line().c_str(),
              settings.session.c_str(), settings.quality.c_str(), options.materials, options.most_lobes);
  std::printf("%-28s   %-17s   %-17s   %-17s   %s\n", "share of itself faced", "under 0.05", "0.05 to 0.2", "0.2 and more", "all");
  FitOptions without = options;
  without.interreflections.choice = InterreflectionChoice::Off;
  Model plain = fit_model(session, without, StageTimer(), quiet).model;
  print("left in", session, plain);
  plain.indirect_bounces = bounces;
  print("left in, and rendered", session, plain);
  const FittedModel fitted = fit_model(session, options, StageTimer(), quiet);
  print("taken out, and rendered", session, fitted.model);
  double seconds = 0.0, all = 0.0;
  for (const StageCost& stage : fitted.summary.stages) {
    all += stage.seconds;
    if (stage.name.starts_with("light between")) seconds += stage.seconds;
  }
  const IndirectSummary& indirect = *fitted.summary.indirect;
  std::printf("can matter on %zu of %zu lumitexels; %.2f %% of the light there; changes by round:", indirect.concerned, fitted.summary.lumitexels,
              100.0 * indirect.share);
  for (const double change : indirect.change) std::printf(" %.2f %%", 100.0 * change);
  std::printf("; %.1f of the fit's %.1f s\n", seconds, all);
}
