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
  int bounces = 0, level = 0;
  std::optional<int> samples_per_pixel;
  std::optional<double> time_limit_s, noise;

  // Rays at the pixel's centre or on a fixed pattern under one lamp, without any chance: ViewRenderer's work.
  bool by_chance(std::size_t lamps) const {
    return !environment.empty() || bounces > 0 || time_limit_s || noise || lamps != 1;
  }
};

void add_render_options(Command& command, RenderSettings& settings);

// Throws BadInput naming the options that contradict each other, are missing, or would do nothing.
void check_render_settings(const RenderSettings& settings, Aov aov);

// What the settings say of the sampled renderer. The environment is read apart.
LitOptions lit_options(const RenderSettings& settings);
Environment environment_of(const RenderSettings& settings, int channels);

}  // namespace lumitexel
