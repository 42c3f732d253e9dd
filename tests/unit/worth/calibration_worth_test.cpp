// What calibrating buys a model: its pictures of unseen views, under cameras, poses and lights as they truly are. The bench over seeds
// and all steps: tests/bench/calibration_worth.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/predicted_view.h"
#include "tests/unit/temporary_folder.h"
#include "tests/unit/worth/relighting_error.h"
#include "tests/unit/worth/same_materials.h"
#include "tests/unit/worth/simulated_capture.h"
#include "tests/unit/worth/true_views.h"

namespace lumitexel {
namespace {

constexpr double kScale = 0.4;  // of the picture's sides

// Four of metrology_small.toml's views, and what calibrates lens and lamp.
constexpr const char* kPlan = R"toml(name = "worth"
mesh = "scan"
gain_db = 0.0
darks_per_exposure = 2
views = [
  { name = "fit_000", split = "fit", turntable_deg = 140.0, light_azimuth_deg = 53.3, light_elevation_deg = 13.5 },
  { name = "fit_002", split = "fit", turntable_deg = 60.0, light_azimuth_deg = -53.3, light_elevation_deg = 55.0 },
  { name = "fit_003", split = "fit", turntable_deg = 260.0, light_azimuth_deg = 0.0, light_elevation_deg = 66.5 },
  { name = "fit_005", split = "fit", turntable_deg = 300.0, light_azimuth_deg = 71.1, light_elevation_deg = 38.6 },
]
[lens]
board_s = 0.02
board_placements = 6
lamp_pattern_s = [0.004, 0.016]
light_azimuth_deg = 17.8
light_elevation_deg = 25.4
[exposures]
bracket_s = [0.004, 0.256]
gray_card_s = [0.032, 0.128]
silhouette_s = 0.02
spheres_ring_s = 0.0005
spheres_point_s = 0.00005
[gray_card]
light_azimuth_deg = 0.0
light_elevation_deg = 66.5
)toml";

RelightingError against(const std::vector<Image>& pictures, const std::vector<Image>& best, const std::vector<TrueView>& views) {
  RelightingSums sums;
  for (std::size_t v = 0; v < views.size(); ++v) sums.add(pictures[v], best[v], views[v].counted);
  return sums.error();
}

// What was photographed is what the truth says: lamp, unit, pattern, pose. Without flat fields the lens's fall-off stays in, some percent
// where the object is, and the lamp's drift of up to 5 %; demosaicing blurs what changes from pixel to pixel.
void expect_photographed(const CalibratedSession& session, const CapturedWorld& captured) {
  const TrueView truth = see_truly(captured.world, {captured.plan.views[2]}).front();
  const RadianceImage photograph = read_photograph(session.views[2], 3);
  const RelightingError error =
      against({photograph.radiance}, {truth.radiance}, {{truth.view, truth.radiance, object_pixels(photograph, truth.counted)}});
  EXPECT_LT(std::abs(error.level), 0.07);
  EXPECT_LT(error.clipped, 0.2);
}

TEST(CalibrationWorth, PosesAndLensBuyBetterPictures) {
  const TemporaryFolder folder;
  std::ofstream(folder / "plan.toml") << kPlan;
  const CapturedWorld captured =
      capture_simulated({LUMITEXEL_SOURCE_DIR "/config/rigs/simulated_metrology.toml", folder / "plan.toml", kScale}, 1, folder.path());
  const auto calibrated = [&](const CalibrationOptions& steps) {
    NoProgress quiet;
    return calibrate_session(captured.session, quiet, nullptr, steps);
  };
  const CalibratedSession session = calibrated({});
  CalibratedSession truth = session;
  take_truth(truth, session_as_it_was(captured));
  expect_photographed(session, captured);

  FitOptions options = FitOptions::preset("draft");
  options.learning_lumitexels = options.final_lumitexels = 500;
  options.materials = 2;
  options.normals = NormalChoice::Auto;
  options.most_lobes = 0;  // what lobes four photographs seem to ask for is another with every calibration: that is not what is asked here
  const SameMaterials materials(truth, options);
  const std::vector<TrueView> unseen = see_truly(captured.world, spread_views(3));
  const auto pictures = [&](const CalibratedSession& calibration) {
    const Model model = materials.fit(calibration);
    const ViewRenderer renderer(model);
    std::vector<Image> result;
    for (const TrueView& view : unseen) result.push_back(predicted_view(renderer, view.view, FitStage::Projection).radiance);
    return result;
  };
  const std::vector<Image> best = pictures(truth);
  const RelightingError all = against(pictures(session), best, unseen);
  const RelightingError no_pose = against(pictures(calibrated({{CalibrationStep::Pose}})), best, unseen);
  const RelightingError no_lens = against(pictures(calibrated({{CalibrationStep::Lens}})), best, unseen);
  EXPECT_GT(no_pose.clipped, 2.0 * all.clipped);  // the object is 5 mm and 3 degrees from where the rig's file has it
  // Poses make up for a wrong lens in the picture, so what it costs is the scale: the object's distance, and with no board's place known
  // the lamp's pattern.
  EXPECT_GT(std::abs(no_lens.level), 3.0 * std::abs(all.level));
  EXPECT_GT(no_lens.clipped, all.clipped);
}

}  // namespace
}  // namespace lumitexel
