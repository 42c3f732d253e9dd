// What the simulated object can be made of. None of these is of the family that the backend fits.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

#include "sim/ggx_brdf.h"
#include "sim/oren_nayar_brdf.h"
#include "sim/sgd_brdf.h"

namespace lumitexel {

struct Material {
  std::string name;
  std::variant<SgdBrdf, GgxBrdf, OrenNayarBrdf> brdf;
  bool textured = false;  // whether the surface pattern modulates its albedo
};

// f per channel in 1/sr; albedo_scale is used by textured materials only.
Eigen::Array3d evaluate(const Material& material, const LobeGeometry& geometry, double albedo_scale);

// "clay" (Oren-Nayar, textured), "glaze" (GGX over a diffuse base), "copper" (GGX metal), or a row of the selected SGD
// table: "red-phenolic", "two-layer-gold", … Throws BadInput naming `where` for any other.
Material material_named(const std::string& name, const std::string& where);

}  // namespace lumitexel
