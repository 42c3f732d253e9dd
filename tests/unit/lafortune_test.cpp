#include "processing/brdf/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lumitexel {
namespace {

Brdf lobe(double kd, double peak, double phi, double exponent) {
  Brdf brdf;
  brdf.channels = 1;
  brdf.diffuse = {kd};
  brdf.lobes = {{Lobe{std::log(peak), std::log(exponent), phi}}};
  return brdf;
}

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

// The paper's form, (Cx (ux vx + uy vy) + Cz uz vz)^N in the local frame, in extended precision.
long double paper_form(const Brdf& brdf, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  const Lobe& l = brdf.lobes[0][0];
  const long double exponent = std::exp(static_cast<long double>(l.log_shape));
  const long double sine = std::sin(static_cast<long double>(l.aim)), cosine = std::cos(static_cast<long double>(l.aim));
  const long double s = std::exp(static_cast<long double>(l.log_strength) / exponent) /
                        std::max(std::abs(sine), std::abs(cosine));
  const long double base = -sine * s * (static_cast<long double>(wi.x()) * wo.x() + static_cast<long double>(wi.y()) * wo.y()) +
                           cosine * s * static_cast<long double>(wi.z()) * wo.z();
  return brdf.diffuse[0] + (base > 0 ? std::pow(base, exponent) : 0.0L);
}

TEST(Lafortune, AgreesWithThePapersForm) {
  // The base is a difference of rounded dot products: its error of some epsilon grows N-fold in the power.
  constexpr double kRelativePerExponent = 1e-14;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> theta(0.0, 1.5), azimuth(0.0, 6.28), phi(0.1, 1.4), log_n(0.0, 6.0);
  int compared = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double exponent = std::exp(log_n(random));
    const Brdf brdf = lobe(0.1, 2.5, phi(random), exponent);
    const Eigen::Vector3d wi = direction(theta(random), azimuth(random)), wo = direction(theta(random), azimuth(random));
    const double value = evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo));
    const auto truth = static_cast<double>(paper_form(brdf, wi, wo));
    EXPECT_NEAR(value, truth, kRelativePerExponent * (1.0 + exponent) * truth * 10.0);
    compared += truth > 0.11;
  }
  EXPECT_GT(compared, 100);  // enough of them inside a lobe for the test to mean something
}

TEST(Lafortune, IsReciprocalAndDoesNotDependOnTheFrame) {
  const Brdf brdf = lobe(0.05, 3.0, 0.7, 40.0);
  const Eigen::Vector3d wi = direction(0.5, 0.3), wo = direction(0.6, 3.2), n = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const double value = evaluate(brdf, 0, lobe_geometry(n, wi, wo));
  EXPECT_EQ(value, evaluate(brdf, 0, lobe_geometry(n, wo, wi)));
  EXPECT_NEAR(value, evaluate(brdf, 0, lobe_geometry(turn * n, turn * wi, turn * wo)), 1e-12 * value);
}

TEST(Lafortune, PeaksAtTheMirrorDirectionAndIsBlackBelowTheHorizon) {
  const Brdf brdf = lobe(0.0, 7.0, 0.7853981633974483, 1e5);
  const Eigen::Vector3d wi = direction(0.5, 0.0);
  EXPECT_NEAR(evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, direction(0.5, M_PI))), 7.0, 7e-9);
  EXPECT_EQ(evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, direction(1.6, M_PI))), 0.0);
}

TEST(Lafortune, StaysFiniteAtTheEndsOfItsRange) {
  for (const double exponent : {1e-2, 1.0, 1e5}) {
    for (const double peak : {1e-6, 1.0, 1e6}) {
      for (const double theta : {0.0, 0.7, 1.5706}) {
        const Brdf brdf = lobe(0.1, peak, 0.7853981633974483, exponent);
        for (const double azimuth : {0.0, 1.57, 3.14159}) {
          const double value = evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), direction(theta, 0.0),
                                                               direction(theta, azimuth)));
          EXPECT_TRUE(std::isfinite(value)) << exponent << ' ' << peak << ' ' << theta;
          EXPECT_GE(value, 0.0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lumitexel
