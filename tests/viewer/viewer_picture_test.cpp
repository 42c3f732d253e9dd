#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "processing/model/render_view.h"
#include "processing/report/viewer/viewer_layers.h"
#include "processing/report/viewer/viewer_page.h"
#include "tests/unit/temporary_folder.h"
#include "tests/viewer/bumpy_model.h"
#include "tests/viewer/viewer_likeness.h"

namespace lumitexel {
namespace {

constexpr double kLeastPsnr_db = 45.0;  // what the viewer promises

void expect_the_ray_tracers(const Model& model) {
  const TemporaryFolder folder;
  std::ofstream(folder / "page.html", std::ios::binary) << viewer_page("bumpy", model).html;
  View view = framing_view(model.mesh, model.channels, 300, {0.5, -1.0, 0.4}, Eigen::Vector3d::UnitZ());
  view.light.vector_in_world += Eigen::Vector3d(4.0, 0.0, 1.0);  // more from the side: longer shadows
  const std::vector<FitStage> stages(std::begin(kFitStages), std::end(kFitStages));
  const auto pictures = browser_pictures(folder / "page.html", view, stages);
  ASSERT_TRUE(pictures.has_value());
  const ModelSurface surface(model);
  for (const FitStage stage : stages) {
    const Likeness found = likeness(surface, view, stage, pictures->at(stage));
    std::cout << to_string(stage) << ": " << found.psnr_db << " dB over " << found.same_texel << " of " << found.object_pixels
              << " pixels, worst " << found.worst << " of white, " << found.other_outline << " pixels of outline differ\n";
    EXPECT_GT(found.object_pixels, 20000);
    EXPECT_GT(found.white, 0.05);
    // The rasteriser's corners are rounded to 1/16 or 1/256 pixel: that moves outlines, by less than a pixel.
    EXPECT_LT(found.other_outline, 100);
    EXPECT_GT(found.same_texel, 0.97 * found.object_pixels);  // the rest: holes of the atlas, and texels' borders
    EXPECT_GT(found.psnr_db, kLeastPsnr_db) << to_string(stage);
  }
}

TEST(ViewerPicture, IsTheRayTracersAtEveryStage) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to draw the viewer's page with";
  expect_the_ray_tracers(bumpy_model());
}

TEST(ViewerPicture, IsTheRayTracersAtEveryStageWhereNormalsWereFitted) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to draw the viewer's page with";
  expect_the_ray_tracers(layered_model());
}

TEST(ViewerStages, AreThoseThatTheModelHolds) {
  const nlohmann::json plain = stages_json(bumpy_model()), layered = stages_json(layered_model());
  ASSERT_EQ(plain.size(), std::size(kFitStages));
  for (std::size_t i = 0; i < std::size(kFitStages); ++i) EXPECT_EQ(plain[i]["name"], to_string(kFitStages[i]));
  EXPECT_EQ(plain[4], (nlohmann::json{{"name", "normal"}, {"held", false}, {"layer", 0}, {"functions", "basis"}, {"texel_normals", true}}));
  EXPECT_EQ(layered[2], (nlohmann::json{{"name", "projection"}, {"held", true}, {"layer", 1}, {"functions", "projection"}, {"texel_normals", false}}));
  EXPECT_EQ(layered[4], (nlohmann::json{{"name", "normal"}, {"held", true}, {"layer", 0}, {"functions", "basis"}, {"texel_normals", true}}));
}

}  // namespace
}  // namespace lumitexel
