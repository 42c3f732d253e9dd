#include <memory>
#include <optional>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "processing/image/tone_map.h"
#include "processing/evaluation/image_error.h"
#include "processing/evaluation/predicted_view.h"
#include "processing/fit/mip_levels.h"
#include "processing/render/carry_model.h"
#include "processing/render/render_lit.h"
#include "processing/render/splat.h"
#include "processing/surface/mesh_file.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/interrupt.h"
#include "rig/console/output_file.h"
#include "rig/console/named_value.h"
#include "rig/console/render_settings.h"
#include "rig/view_selection.h"

namespace lumitexel {
namespace {

constexpr double kWhiteFraction = 0.99;  // of the preview: the brightest hundredth may clip

std::vector<std::pair<std::string, Aov>> aov_words() {
  return {{"radiance", Aov::Radiance}, {"normal", Aov::Normal}, {"position", Aov::Position},
          {"cluster", Aov::Cluster},   {"samples", Aov::Samples}, {"sigma", Aov::Sigma},
          {"normal-sigma", Aov::NormalSigma}};
}

View view_of_session(const RenderSettings& settings, Progress& progress) {
  const SessionStore store = session_given("--session", settings.session);
  const CalibratedSession session = calibrate_session(store, progress);
  std::vector<std::string> names;
  for (const View& view : session.views) names.push_back(view.name);
  return session.views[view_named("--view", settings.view, names)];
}

double preview_white(const Image& image) {
  std::vector<std::uint8_t> lit(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        if (image.at(x, y, c) > 0.0f) lit[image.offset(x, y) / static_cast<std::size_t>(image.channels)] = 1;
      }
    }
  }
  const double white = percentile(image, lit, kWhiteFraction);
  return white > 0.0 ? white : 1.0;
}

struct Rendering {
  Image image;
  int bounces = 0;
  std::optional<LitView> lit;  // of the sampled renderer: how it went
  std::optional<SplatView> points;
};

// Passes over the picture until one of the limits is reached, or until Ctrl-C.
LitView by_passes(const Model& model, const View& view, const Lighting& lighting, const LitOptions& options, Progress& progress) {
  const StopOnInterrupt stop;
  std::fputs("render: pass by pass; Ctrl-C ends with the picture so far\n", stderr);
  return render_lit(model, view, lighting, options, progress, SystemClock(), stop.token());
}

Rendering rendered(const RenderSettings& settings, const Model& model, Aov aov, Progress& progress) {
  View view = settings.session.empty() ? parse_camera(settings.given) : view_of_session(settings, progress);
  if (aov != Aov::Radiance) return {ViewRenderer(model).render_aov(view, aov), 0, {}, {}};
  Lighting lighting{parse_lamps(settings.given, model.channels), nullptr};
  if (!settings.session.empty() && !settings.camera_only) lighting.lamps.insert(lighting.lamps.begin(), view.light);
  const int bounces = settings.bounces_for(model);
  const LitOptions options = lit_options(settings, bounces);
  if (settings.splat) {
    SplatView points = splat(model, view, lighting.lamps, options.stage);
    return {points.radiance, 0, {}, std::move(points)};
  }
  if (settings.of_photograph() && !settings.tells_how_to_sample()) {  // as `evaluate` compares it
    return {predicted_view(ViewRenderer(model), view, options.stage).radiance, bounces, {}, {}};
  }
  if (!settings.by_chance(lighting.lamps.size(), bounces)) {
    view.light = lighting.lamps.front();
    return {ViewRenderer(model).render(view, {options.stage, settings.samples_per_pixel.value_or(1)}).radiance, 0, {}, {}};
  }
  std::optional<Environment> sky;
  if (!settings.environment.empty()) lighting.environment = &sky.emplace(environment_of(settings, model.channels));
  LitView lit = by_passes(model, view, lighting, options, progress);
  return {lit.radiance, bounces, std::move(lit), {}};
}

// Of a camera or a light of one's own the reflectance alone is shown, which lacks what light between surfaces adds.
void note_missing_bounces(const RenderSettings& settings, const Model& model) {
  const int taken_out = bounces_taken_out(model, settings.fit_stage());
  if (taken_out == 0 || settings.bounces || settings.bounces_for(model) > 0) return;
  const std::string cure = settings.splat ? "rays show it with" : "it is shown with";
  std::fprintf(stderr, "note: the fit took light between the object's surfaces out of %s's reflectance, and this picture is without it; %s --bounces %d\n",
               settings.model.c_str(), cure.c_str(), taken_out);
}

void add_outcome(const LitView& lit, CommandResult& result) {
  result.json["samples_per_pixel"] = lit.samples_per_pixel;
  result.json["noise"] = lit.noise ? nlohmann::json(*lit.noise) : nlohmann::json();
  result.json["seconds"] = lit.seconds;
  result.json["ended_by"] = to_string(lit.end);
  result.json["dropped_samples"] = lit.dropped_samples;
  result.text += std::to_string(lit.samples_per_pixel) + " samples a pixel in " + std::to_string(lit.seconds) + " s (" +
                 to_string(lit.end) + "), noise " + (lit.noise ? std::to_string(*lit.noise) : "unknown") +
                 " of the object's radiance\n";
  if (lit.end == RenderEnd::Stopped) result.exit_code = 1;  // less than was asked for
  if (lit.dropped_samples > 0) {
    result.text += std::to_string(lit.dropped_samples) + " samples were not finite and count as black\n";
  }
}

void add_outcome(const SplatView& points, CommandResult& result) {
  result.json["points"] = points.points;
  result.json["points_shown"] = points.shown;
  result.text += std::to_string(points.shown) + " of " + std::to_string(points.points) + " points are seen\n";
}

Model model_to_show(const RenderSettings& settings) {
  const std::filesystem::path folder = settings.level > 0 ? level_directory(settings.model, settings.level) : std::filesystem::path(settings.model);
  if (settings.level > 0 && !std::filesystem::exists(folder)) {
    throw BadInput("--level", std::to_string(settings.level) + ", which is not in " + settings.model, "one that `lumitexel mip " + settings.model + " --levels " + std::to_string(settings.level) + "` makes");
  }
  Model model = model_given("MODEL", folder);
  if (!settings.stage.empty() && !holds_stage(model, fit_stage_from_string(settings.stage))) {
    std::fprintf(stderr, "note: %s does not hold the stage %s; shown is the last one before it\n", settings.model.c_str(), settings.stage.c_str());
  }
  if (!settings.mesh.empty()) model = carried_to(std::move(model), read_mesh(settings.mesh), settings.mesh);
  return model;
}

CommandResult render_command(const RenderSettings& settings, CommandContext& context) {
  const Aov aov = named_value("--aov", settings.aov, aov_words());
  check_render_settings(settings, aov);
  if (settings.out.empty()) throw BadInput("--out", "no name", "an EXR file to write");
  require_writable_folder("--out", settings.out);
  require_writable_folder("--png", settings.png);
  const Model model = model_to_show(settings);
  if (aov == Aov::Radiance) note_missing_bounces(settings, model);
  const Rendering rendering = rendered(settings, model, aov, context.progress);
  const Image& image = rendering.image;
  write_exr_colour(settings.out, image, aov == Aov::Cluster ? ExrPixel::Uint : ExrPixel::Float);

  CommandResult result;
  result.json = {{"out", settings.out}, {"width", image.width}, {"height", image.height}, {"aov", settings.aov}};
  result.text = settings.out + ": " + std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels, " +
                settings.aov + "\n";
  if (rendering.bounces > 0) result.text += "with light between surfaces, after up to " + std::to_string(rendering.bounces) + " bounces\n";
  if (aov == Aov::Radiance) result.json["bounces"] = rendering.bounces;
  if (rendering.lit) add_outcome(*rendering.lit, result);
  if (rendering.points) add_outcome(*rendering.points, result);
  if (!settings.png.empty()) {
    const double white = preview_white(image);
    write_png8(settings.png, tone_mapped(image, white));
    result.json["png"] = settings.png;
    result.json["png_white"] = white;
    result.text += settings.png + ": radiance " + std::to_string(white) + " shown as white\n";
  }
  return result;
}

}  // namespace

void add_render_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<RenderSettings>();
  Command command(app, "render", "Picture of a model from a session's view or a camera of your own: by rays, with bounces if asked, or by points");
  add_render_options(command, *settings);
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return render_command(*settings, context); };
  });
}

}  // namespace lumitexel
