#include "processing/fit/fit_options.h"

#include <limits>

#include "drivers/error.h"

namespace lumitexel {

const char* to_string(NormalChoice choice) {
  switch (choice) {
    case NormalChoice::Fitted: return "fitted";
    case NormalChoice::Mesh: return "mesh";
    case NormalChoice::Auto: break;
  }
  return "auto";
}

FitOptions FitOptions::preset(const std::string& quality) {
  FitOptions options;
  options.quality = quality;
  if (quality == "draft") {
    options.learning_lumitexels = options.final_lumitexels = 2000;
    options.interreflections.rounds = 1;
  } else if (quality == "standard") {
    options.learning_lumitexels = 10000;
    options.final_lumitexels = 5000;
    options.interreflections.rounds = 2;
  } else if (quality == "reference") {
    options.learning_lumitexels = options.final_lumitexels = std::numeric_limits<std::size_t>::max() / 2;
    options.interreflections.rounds = 4;
    options.interreflections.light.paths = 16;
  } else {
    throw BadInput("--quality", "'" + quality + "'", "draft, standard or reference");
  }
  return options;
}

FitOptions as_published(FitOptions options) {
  options.method = FitMethod::Paper;
  options.lobe_shapes = LobeShapes::Separate;
  options.normals = NormalChoice::Mesh;
  options.interreflections.wanted = false;
  options.plain_projection = options.principal_functions = true;
  return options;
}

}  // namespace lumitexel
