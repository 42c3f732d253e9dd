#include "processing/report/doubt.h"

#include <gtest/gtest.h>

#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

Brdf glossy_brdf() {
  Brdf brdf = diffuse_brdf(0.01, 0.01, 0.01);
  brdf.lobes.emplace_back();
  for (std::size_t c = 0; c < 3; ++c) {
    brdf.lobes[0][c].log_strength = 0.0;         // 1/sr in the mirror direction
    brdf.lobes[0][c].log_shape = std::log(60.0);  // some 10 degrees wide
  }
  return brdf;
}

// A square looked at from straight above, the lamp `lamp_deg` off the vertical.
class DoubtOfASquare : public testing::Test {
 protected:
  explicit DoubtOfASquare(const Brdf& brdf = glossy_brdf()) : model_(model_of(square_mesh(), 4, 4, brdf)) {}

  void add_photograph(double lamp_deg, bool heldout = false) {
    View view = view_from_above(32, 3.0);
    view.heldout = heldout;
    const double angle = lamp_deg * std::numbers::pi / 180.0;
    view.light.type = Light::Type::Directional;
    view.light.vector_in_world = Eigen::Vector3d(std::sin(angle), 0.0, std::cos(angle));
    session_.views.push_back(view);
  }
  std::optional<Doubt> doubt() const {
    const ModelSurface surface(model_);
    return doubt_at(surface, session_, *surface.trace({0.1, 0.2, 2.0}, -Eigen::Vector3d::UnitZ()));
  }

  Model model_;
  CalibratedSession session_;
};

TEST_F(DoubtOfASquare, IsTheHighlightThatNoPhotographSaw) {
  add_photograph(50.0);
  EXPECT_EQ(doubt(), Doubt::NoHighlight);
  add_photograph(5.0, true);
  EXPECT_EQ(doubt(), Doubt::NoHighlight) << "the fit did not see those held out";
  add_photograph(5.0);
  EXPECT_EQ(doubt(), Doubt::Scatter);
}

TEST_F(DoubtOfASquare, IsNoHighlightThatHardlyShows) {
  Brdf nearly_matt = glossy_brdf();
  nearly_matt.diffuse = {2.0, 2.0, 2.0};  // over the lobe's strength of 1
  model_ = model_of(square_mesh(), 4, 4, nearly_matt);
  add_photograph(50.0);
  EXPECT_EQ(doubt(), Doubt::Scatter);
}

TEST_F(DoubtOfASquare, IsTooFewSamplesForTheFunctionsToMix) {
  add_photograph(5.0);
  model_.materials[0].basis.resize(8, model_.materials[0].brdf);  // the plain model's texels have 7 samples
  EXPECT_EQ(doubt(), Doubt::FewSamples);
}

TEST_F(DoubtOfASquare, IsTheNormalWhereItsSigmaOutweighsTheReflectances) {
  add_photograph(5.0);
  add_photograph(30.0);
  model_.normal_sigma = Image(4, 4, 1, 0.001f);
  EXPECT_EQ(doubt(), Doubt::Scatter);
  model_.normal_sigma = Image(4, 4, 1, 0.2f);  // over the lobe's width, beside a sigma of a quarter of the reflectance
  EXPECT_EQ(doubt(), Doubt::Normal);
}

TEST_F(DoubtOfASquare, CountsAreByAreaAndOnlyOfWhatWasMeasured) {
  model_ = model_of(square_mesh(), 4, 4, diffuse_brdf(0.1, 0.1, 0.1));
  add_photograph(5.0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 2; ++x) model_.samples.at(x, y) = 0.0f;  // the left half
  }
  EXPECT_FALSE(doubt_at(ModelSurface(model_), session_, *ModelSurface(model_).trace({-0.9, 0.1, 2.0}, -Eigen::Vector3d::UnitZ())).has_value());
  constexpr int kPoints = 400;
  const auto points = doubts_over_surface(ModelSurface(model_), session_, kPoints);
  EXPECT_NEAR(static_cast<double>(points.size()), 0.5 * kPoints, 0.03 * kPoints) << "low discrepancy: some log(n) of n points off";
  for (const DoubtfulPoint& point : points) EXPECT_EQ(point.doubt, Doubt::Scatter);
}

}  // namespace
}  // namespace lumitexel
