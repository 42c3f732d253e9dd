// The options of a fit that benches ask for on their command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "processing/fit/fit_options.h"

namespace lumitexel {

struct FitSettings {
  std::string session, quality = "standard";
  int materials = 6;
  std::optional<int> lobes;
  int normal_rounds = 1;

  void ask_for(CLI::App& app) {
    app.add_option("SESSION", session, "Session, calibrated or imported")->required();
    app.add_option("--quality", quality, "draft, standard or reference")->capture_default_str();
    app.add_option("--materials", materials, "How many; 0: auto")->capture_default_str();
    app.add_option("--lobes", lobes, "Most lobes of a material (default: as the quality has it)");
    app.add_option("--normal-rounds", normal_rounds, "How often normals are fitted, and materials on them")->capture_default_str();
  }
  FitOptions options() const {
    FitOptions options = FitOptions::preset(quality);
    options.materials = materials;
    options.normal_rounds = normal_rounds;
    if (lobes) options.most_lobes = *lobes;
    return options;
  }
};

}  // namespace lumitexel
