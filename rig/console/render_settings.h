// What `lumitexel render` was asked for, and what of it does not go together.
#pragma once

#include <optional>
#include <string>

#include "processing/model/render_view.h"
#include "processing/render/render_lit.h"
#include "rig/console/command_line.h"
#include "rig/console/view_options.h"

namespace lumitexel {

struct RenderSettings {
  std::string model, out, png, session, view, stage, aov = "radiance";
  ViewOptions given;
  bool camera_only = false, splat = false;
  std::string mesh;
  std::string environment, environment_up;
  std::optional<double> environment_scale, environment_turn_deg;
  bool show_environment = false;
  int level = 0;
  std::optional<int> bounces, samples_per_pixel;
  std::optional<double> time_limit_s, noise;

  FitStage fit_stage() const;  // the one asked for, or all that the model holds
  // A photograph once more: the camera and the lamp of a session's view, and no other light.
  bool of_photograph() const {
    return !session.empty() && !camera_only && given.light.empty() && given.directional.empty() && environment.empty();
  }
  bool tells_how_to_sample() const { return bounces || samples_per_pixel || time_limit_s || noise; }
  // As told; else, of a photograph, as many as the fit took out of it.
  int bounces_for(const Model& shown) const {
    return bounces.value_or(of_photograph() && !splat ? bounces_taken_out(shown, fit_stage()) : 0);
  }

  // Rays at the pixel's centre or on a fixed pattern under one lamp, without any chance: ViewRenderer's work.
  bool by_chance(std::size_t lamps, int bounced) const {
    return !environment.empty() || bounced > 0 || time_limit_s || noise || lamps != 1;
  }
};

void add_render_options(Command& command, RenderSettings& settings);

// Throws BadInput naming the options that contradict each other, are missing, or would do nothing.
void check_render_settings(const RenderSettings& settings, Aov aov);

// What the settings say of the sampled renderer. The environment is read apart.
LitOptions lit_options(const RenderSettings& settings, int bounces);
Environment environment_of(const RenderSettings& settings, int channels);

}  // namespace lumitexel
