#include "processing/fit/fit_options.h"

#include <limits>

#include "drivers/error.h"

namespace lumitexel {

const char* to_string(NormalChoice choice) {
  switch (choice) {
    case NormalChoice::Fitted: return "fitted";
    case NormalChoice::Texel: return "texel";
    case NormalChoice::Mesh: return "mesh";
    case NormalChoice::Auto: break;
  }
  return "auto";
}

const char* to_string(InterreflectionChoice choice) {
  switch (choice) {
    case InterreflectionChoice::Always: return "always";
    case InterreflectionChoice::Off: return "off";
    case InterreflectionChoice::Auto: break;
  }
  return "auto";
}

FitOptions FitOptions::preset(const std::string& quality) {
  FitOptions options;
  options.quality = quality;
  if (quality == "draft") {
    options.normals = NormalChoice::Mesh;
    options.interreflections.choice = InterreflectionChoice::Off;
  } else if (quality == "reference") {
    options.learning_lumitexels = 50000;  // where there are twice as many, the others judge choices
    options.final_lumitexels = std::numeric_limits<std::size_t>::max() / 2;
    options.family.reset();
    options.lobe_shapes = LobeShapes::Auto;
    options.most_lobes = 3;
    options.interreflections.rounds = 4;
    options.interreflections.light.paths = 16;
  } else if (quality != "standard") {
    throw BadInput("--quality", "'" + quality + "'", "draft, standard or reference");
  }
  return options;
}

FitOptions as_published(FitOptions options) {
  options.method = FitMethod::Paper;
  if (options.materials == 0) options.materials = kMaterialsOfThePaper;
  options.family = BrdfFamily::Lafortune;
  options.most_lobes = 1;
  options.lobe_shapes = LobeShapes::Separate;
  options.normals = NormalChoice::Mesh;
  options.interreflections.choice = InterreflectionChoice::Off;
  options.plain_projection = options.principal_functions = true;
  return options;
}

}  // namespace lumitexel
