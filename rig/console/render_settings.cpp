#include "rig/console/render_settings.h"

#include <filesystem>
#include <limits>
#include <numbers>
#include <utility>

#include "drivers/error.h"
#include "rig/console/named_value.h"

namespace lumitexel {
namespace {

constexpr int kUsualSamples = 64;
constexpr int kEndlessSamples = 1 << 20;  // where time or noise are to end it: more would not fit the counters' use

void add_view_options(Command& command, RenderSettings& settings) {
  command.add_option("--session", settings.session, "Session whose camera and light are taken, with --view");
  command.add_option("--view", settings.view, "The view's name in the session; an extension such as .exr may be left out");
  command.add_flag("--camera-only", settings.camera_only,
                   "Of the session's view only the camera; the light comes from the options below");
  command.add_option("--camera", settings.given.camera,
                     "\"eye;target;up;fov;WxH\": three points x,y,z in metres, the vertical field of view in degrees, "
                     "the size in pixels");
}

void add_light_options(Command& command, RenderSettings& settings) {
  command.add_option("--light", settings.given.light, "Point light \"x,y,z\" in metres; lights add up");
  command.add_option(
      "--light-intensity", settings.given.light_intensity,
      "W/sr, one number or one a channel; default with --camera: white diffuse at the target has radiance 1");
  command.add_option("--directional", settings.given.directional, "Light from infinitely far, \"x,y,z\" towards it");
  command.add_option(
      "--directional-irradiance", settings.given.directional_irradiance,
      "At normal incidence, one number or one a channel; default pi: white diffuse that faces it has radiance 1");
  command.add_option(
      "--environment", settings.environment,
      "EXR of the light from all around, longitude against latitude, seen from inside: the top row looks up (+z), the "
      "middle column along +x, a quarter of the width to its left along +y");
  command.add_option("--environment-scale", settings.environment_scale,
                     "Its radiance is multiplied by this; default 1");
  command.add_option("--environment-up", settings.environment_up,
                     "\"x,y,z\": where its up is in the world, turned there the shortest way; default 0,0,1");
  command.add_option("--environment-turn", settings.environment_turn_deg,
                     "Degrees by which it is turned about its up, counter-clockwise from above; default 0");
  command.add_flag("--show-environment", settings.show_environment,
                   "Show it beside the object, which is black otherwise");
}

void add_quality_options(Command& command, RenderSettings& settings) {
  command.add_option("--bounces", settings.bounces,
                     "How often light may go from one surface of the model to another before it reaches the camera; 0: "
                     "lights alone. Default: of a session's view under its own lamp, as many as the fit took out of the photographs; else 0, and a "
                     "note where the fit took some out");
  command.add_option("--spp", settings.samples_per_pixel,
                     "Rays a pixel for radiance. Under one lamp alone 1 (the pixel's centre) is the default, more a "
                     "fixed pattern; with an environment, "
                     "bounces or several lamps they are drawn by chance, always alike, and 64 are the default");
  command.add_option("--time-limit", settings.time_limit_s,
                     "Seconds after which no further pass over the picture is made");
  command.add_option(
      "--noise", settings.noise,
      "Enough once the standard error is this part of the radiance (root mean square over the object over its "
      "mean). With --time-limit or --noise and no --spp, rays go on until then");
}

void require_one_way(const RenderSettings& settings, Aov aov) {
  const bool lit =
      !settings.given.light.empty() || !settings.given.directional.empty() || !settings.environment.empty();
  const bool by_session = !settings.session.empty() && !settings.view.empty();
  const bool by_camera = !settings.given.camera.empty() && (lit || aov != Aov::Radiance);
  const bool mixed = !(settings.session.empty() && settings.view.empty()) && !settings.given.camera.empty();
  if (by_session == by_camera || mixed) {
    throw BadInput("render", "no single view",
                   "either --session and --view, or --camera and --light, --directional or --environment");
  }
  if (settings.camera_only && !by_session) throw BadInput("--camera-only", "no --session", "a view of a session");
  if (settings.camera_only && !lit)
    throw BadInput("--camera-only", "no light", "--light, --directional or --environment");
}

// Each option that only says more about another.
void require_what_they_describe(const RenderSettings& settings) {
  const auto require = [](bool given, const char* option, bool described, const char* other) {
    if (given && !described) throw BadInput(option, std::string("no ") + other, std::string(other) + " with it");
  };
  const bool sky = !settings.environment.empty();
  require(!settings.given.light_intensity.empty(), "--light-intensity", !settings.given.light.empty(), "--light");
  require(!settings.given.directional_irradiance.empty(), "--directional-irradiance",
          !settings.given.directional.empty(), "--directional");
  require(settings.environment_scale.has_value(), "--environment-scale", sky, "--environment");
  require(!settings.environment_up.empty(), "--environment-up", sky, "--environment");
  require(settings.environment_turn_deg.has_value(), "--environment-turn", sky, "--environment");
  require(settings.show_environment, "--show-environment", sky, "--environment");
}

// --light stands beside any --camera, so a map may be asked for with it.
void require_options_that_act(const RenderSettings& settings, Aov aov) {
  if (aov == Aov::Radiance) return;
  const std::pair<bool, const char*> idle[] = {{!settings.stage.empty(), "--stage"},
                                               {settings.samples_per_pixel.has_value(), "--spp"},
                                               {!settings.png.empty(), "--png"},
                                               {!settings.given.directional.empty(), "--directional"},
                                               {!settings.environment.empty(), "--environment"},
                                               {settings.splat, "--splat"},
                                               {settings.camera_only, "--camera-only"},
                                               {settings.bounces.has_value(), "--bounces"},
                                               {settings.time_limit_s.has_value(), "--time-limit"},
                                               {settings.noise.has_value(), "--noise"}};
  for (const auto& [given, option] : idle) {
    if (given)
      throw BadInput("--aov", "'" + settings.aov + "' with " + option, std::string(option) + " with radiance only");
  }
}

void require_what_splats_can_show(const RenderSettings& settings) {
  const std::pair<bool, const char*> beyond[] = {{!settings.environment.empty(), "--environment"},
                                                 {settings.bounces.value_or(0) != 0, "--bounces"},
                                                 {settings.samples_per_pixel.has_value(), "--spp"},
                                                 {settings.time_limit_s.has_value(), "--time-limit"},
                                                 {settings.noise.has_value(), "--noise"}};
  for (const auto& [given, option] : beyond) {
    if (settings.splat && given)
      throw BadInput("--splat", std::string("with ") + option, "rays instead, or lamps alone");
  }
}

// A level is a model of the last stage alone, whose normals are means or fitted without a sigma.
void require_what_levels_hold(const RenderSettings& settings, Aov aov) {
  if (settings.level == 0) return;
  const std::string level = std::to_string(settings.level);
  if (!settings.stage.empty()) {
    throw BadInput("--stage", settings.stage + " with --level " + level, "one of them: a coarser level holds the last stage alone");
  }
  if (aov == Aov::NormalSigma) {
    throw BadInput("--aov", settings.aov + " with --level " + level, "another map or no --level: coarser levels do not keep it");
  }
}

}  // namespace

FitStage RenderSettings::fit_stage() const {
  return stage.empty() ? FitStage::Normal : named_value("--stage", stage, words_by_to_string(kFitStages));
}

void add_render_options(Command& command, RenderSettings& settings) {
  command.add_option("MODEL", settings.model, "Folder of the model").required();
  command.add_option("--out", settings.out, "EXR file to write: linear radiance, or the map asked for with --aov")
      .required();
  add_view_options(command, settings);
  add_light_options(command, settings);
  command.add_option("--stage", settings.stage,
                     "single (one BRDF for all), cluster (one a material), projection (a mixture a texel), pfa (of "
                     "principal functions, if "
                     "the fit sought them) or normal (on fitted normals); default: all that the model holds");
  command.add_option("--aov", settings.aov, "radiance, normal, position, cluster, samples, sigma (of reflectance, relative) or normal-sigma (per axis, radians; of a model with fitted normals)")
      .capture_default_str();
  add_quality_options(command, settings);
  command.add_flag("--splat", settings.splat,
                   "Draw the model's texels forward as points instead of casting rays: lamps with shadows only");
  command.add_option(
      "--mesh", settings.mesh,
      "PLY or OBJ: put the maps on this mesh, the model's own (or the scan it was fitted on) bent or moved, with "
      "the same triangles in the same order; texels' normals turn with their triangles");
  command.add_option("--level", settings.level, "Show a coarser level of the maps, made by mip, of the last stage alone: for pictures in which a pixel spans 2^level texels")
      .range(0, 8)
      .capture_default_str();
  command.add_option("--png", settings.png, "Also write a tone-mapped preview of the radiance");
}

void check_render_settings(const RenderSettings& settings, Aov aov) {
  require_one_way(settings, aov);
  require_what_they_describe(settings);
  require_options_that_act(settings, aov);
  require_what_splats_can_show(settings);
  require_what_levels_hold(settings, aov);
  if (std::filesystem::path(settings.out).extension() == ".png") {
    throw BadInput("--out", settings.out, "an .exr file, which is what is written; --png FILE for a preview beside it");
  }
  if (settings.bounces.value_or(0) < 0) throw BadInput("--bounces", std::to_string(*settings.bounces), "0 or more");
}

LitOptions lit_options(const RenderSettings& settings, int bounces) {
  LitOptions options;
  options.stage = settings.fit_stage();
  options.path.bounces = bounces;
  options.path.show_environment = settings.show_environment;
  const bool ends_otherwise = settings.time_limit_s.has_value() || settings.noise.has_value();
  options.limits.samples_per_pixel =
      settings.samples_per_pixel.value_or(ends_otherwise ? kEndlessSamples : kUsualSamples);
  if (settings.time_limit_s) options.limits.time_s = *settings.time_limit_s;
  if (settings.noise) {
    if (!(*settings.noise > 0.0)) throw BadInput("--noise", std::to_string(*settings.noise), "more than 0");
    options.limits.noise = *settings.noise;
  }
  return options;
}

Environment environment_of(const RenderSettings& settings, int channels) {
  const Eigen::Vector3d up = settings.environment_up.empty()
                                 ? Eigen::Vector3d(Eigen::Vector3d::UnitZ())
                                 : parse_vector(settings.environment_up, "--environment-up");
  const double turn_rad = settings.environment_turn_deg.value_or(0.0) * std::numbers::pi / 180.0;
  return read_environment(settings.environment, settings.environment_scale.value_or(1.0),
                          environment_from_world(up, turn_rad), channels);
}

}  // namespace lumitexel
