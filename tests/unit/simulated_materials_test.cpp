#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bad_input_matcher.h"
#include "sim/material.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

LobeGeometry geometry(double theta_i, double theta_o, double phi) {
  return lobe_geometry(Eigen::Vector3d::UnitZ(), direction(theta_i, 0.0), direction(theta_o, phi));
}

std::vector<Material> all_materials() {
  std::vector<Material> materials;
  for (const char* name : {"clay", "glaze", "copper", "red-phenolic", "two-layer-gold", "gold-paint", "gray-plastic",
                           "blue-rubber"}) {
    materials.push_back(material_named(name, "test"));
  }
  return materials;
}

TEST(SimulatedMaterials, AreReciprocalFiniteAndNeverNegative) {
  CounterRandom random(7, 0);
  for (const Material& material : all_materials()) {
    for (int i = 0; i < 2000; ++i) {
      const double theta_i = 0.5 * kPi * random.uniform(), theta_o = 0.5 * kPi * random.uniform();
      const double phi = 2.0 * kPi * random.uniform();
      const Eigen::Array3d there = evaluate(material, geometry(theta_i, theta_o, phi), 0.9);
      const Eigen::Array3d back = evaluate(material, geometry(theta_o, theta_i, phi), 0.9);
      ASSERT_TRUE((there >= 0.0).all() && there.isFinite().all()) << material.name;
      // Only the order of the roundings differs.
      ASSERT_TRUE(((there - back).abs() <= 1e-9 * there.abs().max(1e-3)).all()) << material.name;
    }
  }
}

TEST(SimulatedMaterials, ReflectNothingFromBelowTheSurface) {
  for (const Material& material : all_materials()) {
    EXPECT_TRUE((evaluate(material, geometry(1.7, 0.3, 0.0), 1.0) == 0.0).all()) << material.name;
    EXPECT_TRUE((evaluate(material, geometry(0.3, 1.7, 0.0), 1.0) == 0.0).all()) << material.name;
  }
}

// Integral of f cos(theta_o) over the hemisphere, by the midpoint rule.
double directional_albedo(const Material& material, double theta_i) {
  constexpr int kTheta = 400, kPhi = 400;
  double sum = 0.0;
  for (int i = 0; i < kTheta; ++i) {
    const double theta = (i + 0.5) * 0.5 * kPi / kTheta;
    for (int j = 0; j < kPhi; ++j) {
      const double phi = (j + 0.5) * kPi / kPhi;  // symmetric: half the circle
      sum += evaluate(material, geometry(theta_i, theta, phi), 1.0).maxCoeff() * std::cos(theta) * std::sin(theta);
    }
  }
  return 2.0 * sum * (0.5 * kPi / kTheta) * (kPi / kPhi);
}

TEST(SimulatedMaterials, GgxAndOrenNayarReflectNoMoreThanTheyReceive) {
  const Material white_metal{"white metal", GgxBrdf{0.3, Eigen::Array3d::Ones(), Eigen::Array3d::Zero()}, false};
  const Material white_coat{"white coat", GgxBrdf{0.3, Eigen::Array3d::Constant(0.04), Eigen::Array3d::Ones()}, false};
  const Material white_clay{"white clay", OrenNayarBrdf{Eigen::Array3d::Ones(), 0.35}, false};
  constexpr double kQuadrature = 2e-3;
  for (const double theta_i : {0.0, 0.5, 1.0, 1.3}) {
    EXPECT_LE(directional_albedo(white_metal, theta_i), 1.0 + kQuadrature) << theta_i;
    EXPECT_LE(directional_albedo(white_coat, theta_i), 1.0 + kQuadrature) << theta_i;
    EXPECT_LE(directional_albedo(white_clay, theta_i), 1.0 + kQuadrature) << theta_i;
  }
  // Seen head on, facets within 45 degrees reflect upwards: 1 / (1 + alpha^2) of them, 99 % here. Shadowing takes less than
  // the rest of the margin, so this holds only if D has its right norm.
  const Material smooth_metal{"smooth metal", GgxBrdf{0.1, Eigen::Array3d::Ones(), Eigen::Array3d::Zero()}, false};
  EXPECT_NEAR(directional_albedo(smooth_metal, 0.0), 0.985, 0.01);
}

TEST(GgxBrdf, HasItsClosedFormAtNormalIncidence) {
  const GgxBrdf brdf{0.2, {0.04, 0.5, 1.0}, {0.6, 0.3, 0.0}};
  const Eigen::Array3d f = evaluate(brdf, geometry(0.0, 0.0, 0.0));
  for (int c = 0; c < 3; ++c) {
    const double expected = brdf.f0[c] / (4.0 * kPi * 0.2 * 0.2) +
                            brdf.diffuse[c] / kPi * (1.0 - brdf.f0[c]) * (1.0 - brdf.f0[c]);
    EXPECT_NEAR(f[c], expected, 1e-12 * expected + 1e-15);
  }
}

TEST(OrenNayarBrdf, HasItsClosedFormInRetroreflection) {
  const double s2 = 0.4 * 0.4;
  const double a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  const OrenNayarBrdf brdf{Eigen::Array3d::Constant(0.5), 0.4};
  const double theta = kPi / 4.0;  // sin(theta) tan(theta) = 1 / sqrt(2)
  EXPECT_NEAR(evaluate(brdf, geometry(theta, theta, 0.0))[0], 0.5 / kPi * (a + b / std::sqrt(2.0)), 1e-14);
  EXPECT_NEAR(evaluate(brdf, geometry(theta, theta, kPi))[0], 0.5 / kPi * a, 1e-14);
}

TEST(SgdBrdf, AgreesWithTheFormulaWorkedOutByHand) {
  // Formula of sgd_brdf.h with angles instead of cosines, worked out in another language.
  const SgdBrdf plastic = sgd_from_table(selected_sgd_table(), "gray-plastic", "table");
  const double degree = kPi / 180.0;
  EXPECT_NEAR(evaluate(plastic, geometry(50 * degree, 42 * degree, 170 * degree))[0], 0.06591803962529429, 1e-12);
  const SgdBrdf gold = sgd_from_table(selected_sgd_table(), "two-layer-gold", "table");
  EXPECT_NEAR(evaluate(gold, geometry(75 * degree, 70 * degree, 165 * degree))[2], 0.013618712564991167, 1e-12);
}

TEST(SgdBrdf, AllMeasuredMaterialsAreCarriedAndFinite) {
  const std::vector<std::string> names = sgd_table_names(measured_sgd_table());
  EXPECT_EQ(names.size(), 100u);
  for (const std::string& name : names) {
    const SgdBrdf brdf = sgd_from_table(measured_sgd_table(), name, "table");
    for (const double theta : {0.0, 0.5, 1.0, 1.4}) {
      const Eigen::Array3d f = evaluate(brdf, geometry(theta, theta, kPi));  // towards the mirror direction
      EXPECT_TRUE(f.isFinite().all() && (f >= 0.0).all()) << name << " at " << theta;
    }
  }
}

TEST(SgdBrdf, TheSimulationsRowsAreTheAuthorsRows) {
  for (const std::string& name : sgd_table_names(selected_sgd_table())) {
    const SgdBrdf own = sgd_from_table(selected_sgd_table(), name, "table"), authors = sgd_from_table(measured_sgd_table(), name, "table");
    EXPECT_TRUE((evaluate(own, geometry(0.9, 0.8, 2.9)) == evaluate(authors, geometry(0.9, 0.8, 2.9))).all()) << name;
  }
  // What a rig's file may name has not grown with the table.
  EXPECT_BAD_INPUT(material_named("alum-bronze", "rig.toml"), "alum-bronze");
}

TEST(SgdBrdf, RefusesATableWithoutTheMaterialOrWithoutANumber) {
  EXPECT_BAD_INPUT(sgd_from_table(selected_sgd_table(), "cheese", "table.csv"), "table.csv");
  EXPECT_BAD_INPUT(sgd_from_table("material,rhoD_r\nx,1.2y\n", "x", "table.csv"), "rhoD_r");
  EXPECT_BAD_INPUT(material_named("cheese", "rig.toml: simulation.materials"), "cheese");
}

}  // namespace
}  // namespace lumitexel
