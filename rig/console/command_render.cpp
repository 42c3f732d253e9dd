#include <memory>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "processing/image/tone_map.h"
#include "processing/model/image_error.h"
#include "processing/model/render_view.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/named_value.h"
#include "rig/console/view_options.h"
#include "rig/view_selection.h"

namespace lumitexel {
namespace {

constexpr double kWhiteFraction = 0.99;  // of the preview: the brightest hundredth may clip

struct RenderSettings {
  std::string model, out, png, session, view, stage, aov = "radiance";
  ViewOptions given;
  int samples_per_pixel = 1;
};

std::vector<std::pair<std::string, Aov>> aov_words() {
  return {{"radiance", Aov::Radiance}, {"normal", Aov::Normal}, {"position", Aov::Position},
          {"cluster", Aov::Cluster},   {"samples", Aov::Samples}, {"sigma", Aov::Sigma}};
}

View view_of_session(const RenderSettings& settings, Progress& progress) {
  const SessionStore store = session_given("--session", settings.session);
  const CalibratedSession session = calibrate_session(store, progress);
  std::vector<std::string> names;
  for (const View& view : session.views) names.push_back(view.name);
  return session.views[view_named("--view", settings.view, names)];
}

void require_one_way(const RenderSettings& settings) {
  const bool by_session = !settings.session.empty() && !settings.view.empty();
  const bool by_camera = !settings.given.camera.empty() && !settings.given.light.empty();
  const bool mixed = !(settings.session.empty() && settings.view.empty()) && !settings.given.camera.empty();
  if (by_session == by_camera || mixed) {
    throw BadInput("render", "no single view", "either --session and --view, or --camera and --light");
  }
}

void require_options_that_act(const RenderSettings& settings, Aov aov) {
  if (aov != Aov::Radiance && (!settings.stage.empty() || settings.samples_per_pixel != 1 || !settings.png.empty())) {
    throw BadInput("--aov", "'" + settings.aov + "' with --stage, --spp or --png", "these with radiance only");
  }
  if (!settings.session.empty() && !(settings.given.light.empty() && settings.given.light_intensity.empty())) {
    throw BadInput("--light", "given with --session", "the session's own light, or --camera");
  }
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

CommandResult render_command(const RenderSettings& settings, CommandContext& context) {
  require_one_way(settings);
  const Aov aov = named_value("--aov", settings.aov, aov_words());
  require_options_that_act(settings, aov);
  const Model model = model_given("MODEL", settings.model);
  RenderOptions options;
  if (!settings.stage.empty()) options.stage = named_value("--stage", settings.stage, words_by_to_string(kFitStages));
  options.samples_per_pixel = settings.samples_per_pixel;
  const View view = settings.session.empty() ? parse_view(settings.given, model.channels)
                                             : view_of_session(settings, context.progress);
  const ViewRenderer renderer(model);
  const Image image = aov == Aov::Radiance ? renderer.render(view, options).radiance : renderer.render_aov(view, aov);
  write_exr_colour(settings.out, image, aov == Aov::Cluster ? ExrPixel::Uint : ExrPixel::Float);

  CommandResult result;
  result.json = {{"out", settings.out}, {"width", image.width}, {"height", image.height}, {"aov", settings.aov}};
  result.text = settings.out + ": " + std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels, " +
                settings.aov + "\n";
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
  CLI::App* command = app.add_subcommand("render", "Ray trace a model from a session's view or a camera of your own");
  command->add_option("MODEL", settings->model, "Folder of the model")->required();
  command->add_option("--out", settings->out, "EXR file to write: linear radiance, or the map asked for with --aov")
      ->required();
  command->add_option("--session", settings->session, "Session whose camera and light are taken, with --view");
  command->add_option("--view", settings->view, "The view's name in the session; an extension such as .exr may be left out");
  command->add_option("--camera", settings->given.camera,
                      "\"eye;target;up;fov;WxH\": three points x,y,z in metres, the vertical field of view in degrees, "
                      "the size in pixels");
  command->add_option("--light", settings->given.light, "Point light \"x,y,z\" in metres, with --camera");
  command->add_option("--light-intensity", settings->given.light_intensity,
                      "W/sr, one number or one a channel; default: white diffuse at the target has radiance 1");
  command->add_option("--stage", settings->stage, "single (one BRDF for all), cluster (one a material), projection (a mixture a texel) or pfa (of principal functions, if "
                      "the fit sought them); default: all that the model holds");
  command->add_option("--aov", settings->aov, words_of(aov_words()))
      ->capture_default_str();
  command->add_option("--spp", settings->samples_per_pixel, "Rays a pixel for radiance; 1 is the pixel's centre")
      ->capture_default_str();
  command->add_option("--png", settings->png, "Also write a tone-mapped preview");
  command->callback([settings, &action] {
    action = [settings](CommandContext& context) { return render_command(*settings, context); };
  });
}

}  // namespace lumitexel
