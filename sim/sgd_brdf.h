// Shifted Gamma Distribution microfacet model (Bagher, Soler, Holzschuch, EGSR 2012), as fitted to the MERL materials:
//
//   f = (rho_d + rho_s F D G / (cos i cos o)) / pi
//   F = F0 - c F1 + (1 - c)^5 (1 - F0),                      c = cos(theta_d)
//   D = kap exp(-a) / (pi a^p cos^4(theta_h)),               a = alpha + tan^2(theta_h) / alpha
//   G = g(theta_i) g(theta_o),  g(t) = clamp(1 + lambda (1 - exp(c max(0, t - theta_0)^k)), 0, 1)
//
// f in 1/sr. Reciprocal by form. The fits are not bounded to conserve energy; F is kept from going negative.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "processing/brdf/brdf.h"

namespace lumitexel {

// One entry per channel.
struct SgdBrdf {
  Eigen::Array3d rho_d, rho_s, alpha, p, f0, f1, kap, lambda, c, k, theta0;
};

// f per channel. albedo_scale multiplies rho_d. 0 if either direction is not above the surface.
Eigen::Array3d evaluate(const SgdBrdf& brdf, const LobeGeometry& geometry, double albedo_scale = 1.0);

// The row `material` of a table in the authors' columns ("material,rhoD_r,rhoD_g,…"), '#' lines skipped.
// Throws BadInput naming `where` if the row or a column is missing or is no number.
SgdBrdf sgd_from_table(std::string_view csv, const std::string& material, const std::string& where);
std::vector<std::string> sgd_table_names(std::string_view csv);  // of its rows, in order
bool sgd_table_has(std::string_view csv, const std::string& material);

// config/materials/merl_sgd_selected.csv, which the simulation uses, and merl_sgd.csv, all that the authors published, as they were when
// the program was built.
std::string_view selected_sgd_table();
std::string_view measured_sgd_table();

}  // namespace lumitexel
