#include "processing/image/response_curve.h"

#include <algorithm>
#include <cmath>

#include "drivers/error.h"

namespace lumitexel {

ResponseCurve::ResponseCurve(std::vector<double> code_dn, std::vector<double> linear_dn)
    : code_dn_(std::move(code_dn)), linear_dn_(std::move(linear_dn)) {
  const auto rises = [](const std::vector<double>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!std::isfinite(nodes[i]) || (i > 0 && !(nodes[i] > nodes[i - 1]))) return false;
    }
    return true;
  };
  if (code_dn_.size() < 2 || code_dn_.size() != linear_dn_.size() || !rises(code_dn_) || !rises(linear_dn_)) {
    throw BadInput("response curve", std::to_string(code_dn_.size()) + " nodes that do not all rise",
                   "at least two nodes, code and linear value strictly rising");
  }
}

std::size_t ResponseCurve::segment(const std::vector<double>& nodes, double at) const {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  return static_cast<std::size_t>(above - nodes.begin()) - 1;
}

double ResponseCurve::linear_dn(double code) const {
  const std::size_t i = segment(code_dn_, code);
  return linear_dn_[i] + (code - code_dn_[i]) * (linear_dn_[i + 1] - linear_dn_[i]) / (code_dn_[i + 1] - code_dn_[i]);
}

double ResponseCurve::code_dn(double linear) const {
  const std::size_t i = segment(linear_dn_, linear);
  return code_dn_[i] + (linear - linear_dn_[i]) * (code_dn_[i + 1] - code_dn_[i]) / (linear_dn_[i + 1] - linear_dn_[i]);
}

double ResponseCurve::slope_at(double linear) const {
  const std::size_t i = segment(linear_dn_, linear);
  return (linear_dn_[i + 1] - linear_dn_[i]) / (code_dn_[i + 1] - code_dn_[i]);
}

std::vector<double> ResponseCurve::table(int bits) const {
  std::vector<double> values(std::size_t{1} << bits);
  for (std::size_t code = 0; code < values.size(); ++code) values[code] = linear_dn(static_cast<double>(code));
  return values;
}

}  // namespace lumitexel
