// What the user may choose about a fit.
#pragma once

#include <cstddef>
#include <string>

namespace lumitexel {

struct FitOptions {
  std::string quality = "standard";
  int materials = 4;
  std::size_t learning_lumitexels = 10000;  // that the materials are learnt on
  std::size_t final_lumitexels = 5000;      // of its own that each material is fitted to at the end
  bool shared_lobe_shape = true;            // one lobe shape for all channels of a material
  bool plain_projection = false;            // the paper's least squares for the weights, without a prior
  // What no model on the coarse mesh can predict: a share of each prediction, and a share of the session's median
  // reflectance under everything. Both found on held-out photographs of two sessions; see the README.
  double relative_error = 0.3, error_floor_share = 0.3;

  // Learning and final lumitexels. draft: 2,000, 2,000; standard: 10,000, 5,000; reference: all. Throws BadInput on any other name.
  static FitOptions preset(const std::string& quality);
};

}  // namespace lumitexel
