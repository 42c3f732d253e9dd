// How the samples of a sensor that is not linear grow with light: from raw numbers to linear ones and back.
#pragma once

#include <vector>

#include "drivers/camera.h"

namespace lumitexel {

// Strictly rising, linear between its nodes, extended linearly beyond them. linear_dn is in the sensor's DN, so that the
// noise model holds on: equal to (code_dn - black level) at one node, by convention of whoever made the curve.
class ResponseCurve {
 public:
  // Nodes; at least two, both strictly rising and finite. Throws BadInput otherwise.
  ResponseCurve(std::vector<double> code_dn, std::vector<double> linear_dn);

  double linear_dn(double code_dn) const;
  double code_dn(double linear_dn) const;
  // d linear / d code at this linear value: noise added to the code is multiplied by it.
  double slope_at(double linear_dn) const;
  // linear_dn of every code of so many bits.
  std::vector<double> table(int bits) const;

 private:
  std::size_t segment(const std::vector<double>& nodes, double at) const;
  std::vector<double> code_dn_, linear_dn_;
};

}  // namespace lumitexel
