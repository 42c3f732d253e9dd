// The options of a fit that benches ask for on their command line.
#pragma once

#include <CLI/CLI.hpp>

#include "processing/fit/fit_options.h"

namespace lumitexel {

struct FitSettings {
  std::string session, quality = "draft";
  int materials = 6, lobes = 1;

  void ask_for(CLI::App& app) {
    app.add_option("SESSION", session, "Session, calibrated or imported")->required();
    app.add_option("--quality", quality, "draft, standard or reference")->capture_default_str();
    app.add_option("--materials", materials, "As fit has it; 0: auto")->capture_default_str();
    app.add_option("--lobes", lobes, "As fit has it")->capture_default_str();
  }
  FitOptions options() const {
    FitOptions options = FitOptions::preset(quality);
    options.materials = materials;
    options.most_lobes = lobes;
    return options;
  }
};

}  // namespace lumitexel
