#include "sim/material.h"

#include "drivers/error.h"

namespace lumitexel {

Eigen::Array3d evaluate(const Material& material, const LobeGeometry& geometry, double albedo_scale) {
  const double scale = material.textured ? albedo_scale : 1.0;
  return std::visit([&](const auto& brdf) { return evaluate(brdf, geometry, scale); }, material.brdf);
}

Material material_named(const std::string& name, const std::string& where) {
  if (name == "clay") return {name, OrenNayarBrdf{{0.58, 0.47, 0.33}, 0.35}, true};
  if (name == "glaze") return {name, GgxBrdf{0.16, Eigen::Array3d::Constant(0.05), {0.05, 0.21, 0.24}}, false};
  if (name == "copper") return {name, GgxBrdf{0.22, {0.95, 0.64, 0.54}, Eigen::Array3d::Zero()}, false};
  if (sgd_table_has(selected_sgd_table(), name)) {
    return {name, sgd_from_table(selected_sgd_table(), name, "the built-in SGD table"), false};
  }
  throw BadInput(where, "'" + name + "'", "clay, glaze, copper or a row of config/materials/merl_sgd_selected.csv");
}

}  // namespace lumitexel
