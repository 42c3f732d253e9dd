// What the user may choose about a fit.
#pragma once

#include <cstddef>
#include <string>

#include "processing/brdf/error_model.h"

namespace lumitexel {

struct FitOptions {
  std::string quality = "standard";
  int materials = 4;
  std::size_t learning_lumitexels = 10000;  // that the materials are learnt on, before the final fit on all
  bool shared_lobe_shape = true;            // one lobe shape for all channels of a material
  ErrorModel error;

  // draft: 2,000 lumitexels; standard: 10,000; reference: all. Throws BadInput on any other name.
  static FitOptions preset(const std::string& quality);
};

}  // namespace lumitexel
