// Radiance with a closed form: furnaces, enclosures, and ways of drawing the same light that must agree.
#include "processing/render/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "processing/model/render_view.h"
#include "processing/render/render_lit.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/render/skies.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 4.0;  // one run in 16,000 goes beyond by chance; all seeds are fixed
constexpr double kRounding = 2e-6;

struct Mean {
  double value = 0, sigma = 0;
};

// Over the object's pixels and all channels. Channels err together, pixels do not.
Mean mean_of(const LitView& lit) {
  double sum = 0.0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < lit.radiance.data.size(); ++i) {
    if (lit.hit[i / 3] == 0) continue;
    sum += lit.radiance.data[i];
    ++values;
  }
  const double value = sum / static_cast<double>(values);
  return {value, lit.noise.value_or(0.0) * value / std::sqrt(static_cast<double>(values) / 3.0)};
}

LitView lit_by(const Model& model, const View& view, const Lighting& lighting, const PathOptions& path, int samples) {
  NoProgress silent;
  return render_lit(model, view, lighting, {FitStage::Pfa, path, {samples}}, silent, SystemClock());
}

Brdf glossy_brdf(BrdfFamily family, double log_strength, double shape) {
  Brdf brdf;
  brdf.family = family;
  brdf.diffuse = {0.05, 0.03, 0.01};
  brdf.lobes.resize(1);
  brdf.lobes[0].fill({log_strength, std::log(shape), kMirrorAim});
  return brdf;
}

// The unit sphere seen from inside, or only its lower half.
Mesh hollow_sphere(bool lower_half) {
  Mesh mesh = sphere_mesh(120, 60);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (Eigen::Vector3d& normal : mesh.normals) normal = -normal;
  if (lower_half) {
    std::erase_if(mesh.triangles, [&](const auto& triangle) {
      return mesh.positions[triangle[0]].z() + mesh.positions[triangle[1]].z() + mesh.positions[triangle[2]].z() > 0.0;
    });
  }
  return mesh;
}
constexpr double kHollowFacets = 2e-3;  // chords of 120 segments, in area and in direction

// From the middle straight down, 60 degrees across.
View view_from_within(int size_px) {
  View view = view_from_above(size_px, 1.0);
  view.camera.focal_x_px = view.camera.focal_y_px = 0.5 * size_px / std::tan(kPi / 6);
  view.camera_from_world.translation().setZero();
  return view;
}

TEST(PathTracer, AFlatDiffusePlateUnderAConstantSkyShinesByItsAlbedo) {
  const Model model = model_of(square_mesh(), 4, 4, diffuse_brdf(0.1, 0.2, 0.3));
  const Environment sky = constant_sky(1.0, 2.0, 0.5);
  for (const auto sampling :
       {EnvironmentSampling::Combined, EnvironmentSampling::Environment, EnvironmentSampling::Brdf}) {
    PathOptions path;
    path.sampling = sampling;
    const LitView lit = lit_by(model, view_from_above(16, 5.0), {{}, &sky}, path, 256);
    const double expected[] = {0.1 * kPi, 0.2 * kPi * 2.0, 0.3 * kPi * 0.5};
    const Mean all = mean_of(lit);
    EXPECT_NEAR(all.value, (expected[0] + expected[1] + expected[2]) / 3.0, kSigmas * all.sigma + kRounding);
    for (int c = 0; c < 3; ++c) {
      // Stratified: far better than the 3 % of 256 independent samples of a cosine.
      EXPECT_NEAR(lit.radiance.at(7, 9, c), expected[c], 0.02 * expected[c]) << c;
    }
    EXPECT_EQ(lit.dropped_samples, 0);
    if (sampling == EnvironmentSampling::Brdf) {
      EXPECT_LT(*lit.noise, 1e-6) << "a cosine drawn by the cosine does not scatter";
    }
  }
}

// Light from above both the plate and the tilted normal's horizon: of a cosine lobe about the normal the part above the
// plate, (1 + cos) / 2. Nothing is reflected from below the plate.
TEST(PathTracer, ATiltedNormalLosesWhatThePlateHides) {
  Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(0.3, 0.3, 0.3));
  const Eigen::Vector3f tilted(0.8f, 0.0f, 0.6f);
  std::copy(tilted.data(), tilted.data() + 3, model.normal.data.begin());
  const Environment sky = constant_sky(1.0, 1.0, 1.0);
  const Mean mean = mean_of(lit_by(model, view_from_above(16, 5.0), {{}, &sky}, {}, 256));
  EXPECT_LT(mean.sigma, 2e-3 * mean.value);
  EXPECT_NEAR(mean.value, 0.3 * kPi * 0.8, kSigmas * mean.sigma);
}

// A lobe's reflected energy, seen through the whole renderer: constant light times the albedo by quadrature.
TEST(PathTracer, AGlossyPlateUnderAConstantSkyShinesByTheAlbedoOfQuadrature) {
  const Environment sky = constant_sky(1.0, 1.0, 1.0);
  for (const auto& [family, strength, shape] :
       {std::tuple{BrdfFamily::Ggx, 0.5, 0.15}, {BrdfFamily::Ward, 0.4, 0.1}, {BrdfFamily::Lafortune, 8.0, 80.0}}) {
    const Brdf brdf = glossy_brdf(family, std::log(strength), shape);
    const Model model = model_of(square_mesh(), 1, 1, brdf);
    View view = view_from_above(8, 40.0);  // all but parallel rays, turned to look along a slope of 45 degrees
    view.camera.focal_x_px *= 1.5;         // the plate fills the picture
    view.camera.focal_y_px *= 1.5;
    const Eigen::AngleAxisd lean(kPi / 4, Eigen::Vector3d::UnitX());
    view.camera_from_world = view.camera_from_world * Eigen::Isometry3d(lean);
    const Mean mean = mean_of(lit_by(model, view, {{}, &sky}, {}, 128));
    const Eigen::Vector3d wo(0.0, std::sqrt(0.5), std::sqrt(0.5));
    double expected = 0.0;
    constexpr int kSide = 1200;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const double z2 = (i + 0.5) / kSide, azimuth = 2 * kPi * (j + 0.5) / kSide, level = std::sqrt(1 - z2);
        const Eigen::Vector3d wi(level * std::cos(azimuth), level * std::sin(azimuth), std::sqrt(z2));
        const ChannelValues f = evaluate(brdf, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo));
        expected += kPi / (kSide * kSide) * (f[0] + f[1] + f[2]) / 3.0;
      }
    }
    EXPECT_LT(mean.sigma, 2e-3 * mean.value);
    constexpr double kSlope = 2e-3;  // rays differ by up to 1.4 degrees, to both sides
    EXPECT_NEAR(mean.value, expected, kSigmas * mean.sigma + kSlope * expected) << to_string(family);
  }
}

TEST(PathTracer, AllWaysOfDrawingTheSkyAgree) {
  const Environment sky = uneven_sky(16, 8);
  const Model model = model_of(sphere_mesh(60, 30), 8, 4, glossy_brdf(BrdfFamily::Ggx, std::log(0.5), 0.3));
  const View view = view_from_above(24, 4.0);
  const auto mean = [&](EnvironmentSampling sampling, int samples) {
    PathOptions path;
    path.sampling = sampling;
    path.bounces = 1;
    return mean_of(lit_by(model, view, {{}, &sky}, path, samples));
  };
  const Mean uniform = mean(EnvironmentSampling::Uniform, 1024);
  for (const auto sampling :
       {EnvironmentSampling::Combined, EnvironmentSampling::Environment, EnvironmentSampling::Brdf}) {
    const Mean other = mean(sampling, sampling == EnvironmentSampling::Brdf ? 2048 : 256);
    EXPECT_NEAR(other.value, uniform.value, kSigmas * std::hypot(other.sigma, uniform.sigma));
    EXPECT_LT(kSigmas * std::hypot(other.sigma, uniform.sigma), 0.03 * uniform.value) << "no agreement by vagueness";
  }
  EXPECT_LT(mean(EnvironmentSampling::Combined, 64).sigma, 0.5 * mean(EnvironmentSampling::Uniform, 64).sigma)
      << "what it is for";
}

// A lamp in the middle of a closed diffuse sphere: every point gets the same, from the lamp and then from all others,
// so bounce k adds kd E (pi kd)^k.
TEST(PathTracer, LightInAClosedSphereIsAGeometricSeries) {
  const double kd = 0.6 / kPi;
  const Model model = model_of(hollow_sphere(false), 4, 2, diffuse_brdf(kd, kd, kd));
  Light lamp;
  lamp.intensity = {2.0, 2.0, 2.0};
  double expected = 0.0;
  for (int bounces = 0; bounces <= 3; ++bounces) {
    expected += kd * 2.0 * std::pow(0.6, bounces);
    PathOptions path;
    path.bounces = bounces;
    const Mean mean = mean_of(lit_by(model, view_from_within(12), {{lamp}, nullptr}, path, 64));
    EXPECT_NEAR(mean.value, expected, kSigmas * mean.sigma + kHollowFacets * expected) << bounces;
  }
}

// Of the light that leaves a point in a hemispherical bowl half meets the bowl again, wherever the point is.
TEST(PathTracer, ABowlUnderAConstantSkyIsAGeometricSeriesToo) {
  const double albedo = 0.9, kd = albedo / kPi;
  const Model model = model_of(hollow_sphere(true), 4, 2, diffuse_brdf(kd, kd, kd));
  const Environment sky = constant_sky(1.0, 1.0, 1.0);
  for (const int bounces : {0, 1, 4}) {
    double expected = 0.0;
    for (int k = 0; k <= bounces; ++k) expected += std::pow(0.5 * albedo, k + 1);
    PathOptions path;
    path.bounces = bounces;
    const Mean mean = mean_of(lit_by(model, view_from_within(12), {{}, &sky}, path, 1024));
    EXPECT_LT(mean.sigma, 2e-3 * mean.value);
    EXPECT_NEAR(mean.value, expected, kSigmas * mean.sigma + kHollowFacets * expected) << bounces;
  }
}

// A BRDF that reflects half more than it gets: direct light as it says, between surfaces no gain, so each bounce adds
// as much as the first light did.
TEST(PathTracer, NoBounceGainsEnergy) {
  const double kd = 1.5 / kPi;
  const Model model = model_of(hollow_sphere(false), 4, 2, diffuse_brdf(kd, kd, kd));
  Light lamp;
  lamp.intensity = {1.0, 1.0, 1.0};
  for (const int bounces : {0, 5}) {
    PathOptions path;
    path.bounces = bounces;
    const Mean mean = mean_of(lit_by(model, view_from_within(12), {{lamp}, nullptr}, path, 64));
    const double expected = kd * (1.0 + bounces);
    EXPECT_NEAR(mean.value, expected, kSigmas * mean.sigma + kHollowFacets * expected * (1 + bounces)) << bounces;
  }
}

TEST(PathTracer, LampsAloneAreWhatTheSingleViewRendererShows) {
  Model model = model_of(sphere_mesh(80, 40), 16, 8, glossy_brdf(BrdfFamily::Ward, std::log(0.3), 0.3));
  model.materials.push_back({diffuse_brdf(0.3, 0.2, 0.1), {diffuse_brdf(0.3, 0.2, 0.1)}});
  for (std::size_t t = 0; t < model.material.size(); t += 3) model.material[t] = 1;  // blends at every other texel
  View view = view_from_above(24, 4.0);
  view.light.type = Light::Type::Point;
  view.light.vector_in_world = {2.0, 1.0, 3.0};
  view.light.intensity = {9.0, 9.0, 9.0};
  const Mean path = mean_of(lit_by(model, view, {{view.light}, nullptr}, {}, 256));
  const RenderedView plain = ViewRenderer(model).render(view, {FitStage::Pfa, 1024});
  double sum = 0.0, pixels = 0.0;
  const LitView mask = lit_by(model, view, {{view.light}, nullptr}, {}, 256);
  for (std::size_t i = 0; i < plain.radiance.data.size(); ++i) {
    if (mask.hit[i / 3] == 0) continue;
    sum += plain.radiance.data[i];
    pixels += 1.0;
  }
  constexpr double kPattern = 5e-4;  // of the other's 1024 points a pixel
  EXPECT_NEAR(path.value, sum / pixels, kSigmas * path.sigma + kPattern * path.value);
  EXPECT_LT(path.sigma, 2e-3 * path.value);
}

TEST(PathTracer, LightsAddUp) {
  const Environment sky = uneven_sky(16, 8);
  const Model model = model_of(sphere_mesh(60, 30), 8, 4, glossy_brdf(BrdfFamily::Ward, std::log(0.3), 0.3));
  const View view = view_from_above(16, 4.0);
  Light point, directional;
  point.vector_in_world = {2.0, 1.0, 3.0};
  point.intensity = {5.0, 4.0, 3.0};
  directional.type = Light::Type::Directional;
  directional.vector_in_world = Eigen::Vector3d(-1.0, 1.0, 1.0).normalized();
  directional.intensity = {1.0, 2.0, 3.0};
  const auto radiance = [&](const Lighting& lighting) { return lit_by(model, view, lighting, {}, 8).radiance; };
  const Image all = radiance({{point, directional}, &sky});
  const Image one = radiance({{point}, nullptr}), two = radiance({{directional}, nullptr}),
              three = radiance({{}, &sky});
  for (std::size_t i = 0; i < all.data.size(); ++i) {
    const double sum = static_cast<double>(one.data[i]) + two.data[i] + three.data[i];  // the same numbers were drawn
    EXPECT_NEAR(all.data[i], sum, 1e-5 * (1.0 + sum));
  }
}

TEST(PathTracer, TheSkyShowsBesideTheObjectOnlyWhenAsked) {
  const Environment sky = constant_sky(1.0, 2.0, 3.0);
  const Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(0.1, 0.1, 0.1));
  View view = view_from_above(16, 5.0);
  view.camera.focal_x_px = view.camera.focal_y_px = 20.0;  // the square fills the middle half
  PathOptions path;
  EXPECT_EQ(lit_by(model, view, {{}, &sky}, path, 2).radiance.at(0, 0, 1), 0.0f);
  path.show_environment = true;
  const LitView shown = lit_by(model, view, {{}, &sky}, path, 2);
  EXPECT_EQ(shown.radiance.at(0, 0, 1), 2.0f);
  EXPECT_EQ(shown.hit[0], 0);
  EXPECT_EQ(shown.hit[8 * 16 + 8], 1);
}

}  // namespace
}  // namespace lumitexel
