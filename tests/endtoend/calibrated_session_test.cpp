// A bench that is wrong in everything, calibrated; and a lens calibration that outlives its session.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/endtoend/run_program.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using nlohmann::json;
const std::string kSource = LUMITEXEL_SOURCE_DIR;
const std::string kRig = kSource + "/config/rigs/simulated_metrology.toml";

json calibrated(const std::string& arguments) {
  const ProgramRun run = run_program("calibrate " + arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return run.exit_code == 0 ? run.json() : json::object();
}

double figure(const json& result, const char* what, const char* which) {
  return result.at(what).at(which).get<double>();
}

// simulated_metrology.toml: lens 0.5 %, camera 3 mm and 0.3 degrees, object 5 mm and 3 degrees, lamp 5 % over the session and
// cos^8, gray card 3.7 mm and 2.7 degrees, 12 % vignetting, 5 K of warming.
TEST(CalibratedSession, FindsWhatIsWrongWithTheBench) {
  const TemporaryFolder folder;
  const std::string session = (folder / "session").string(), page = (folder / "page.html").string();
  const ProgramRun capture =
      run_program("capture " + kRig + " " + kSource + "/config/plans/metrology_small.toml --out " + session);
  ASSERT_EQ(capture.exit_code, 0) << capture.errors;

  const json result = calibrated(session + " --page " + page);
  EXPECT_LT(figure(result, "irradiance_error", "median"), 0.003);  // the goal for a lamp that drifts by 5 %
  EXPECT_LT(figure(result, "irradiance_error", "max"), 0.01);
  const json& pose = result.at("poses").at(0);
  // Three standard deviations; six unknowns share them.
  EXPECT_LT(figure(result, "pose_error_mm", "median"), 3e3 * pose.at("sigma_m").get<double>());
  EXPECT_LT(figure(result, "pose_error_deg", "median"), 3.0 * pose.at("sigma_deg").get<double>());
  EXPECT_LT(pose.at("silhouette_px").get<double>(), 0.3);
  EXPECT_LT(figure(result, "light_error_mm", "median"), 3e3 * std::sqrt(3.0) * result.at("lights").at(0).at("sigma_m").get<double>());
  EXPECT_LT(result.at("camera").at("reprojection_px").get<double>(), 0.1);
  EXPECT_TRUE(result.at("lamp").at("drifts").get<bool>());
  EXPECT_EQ(result.at("lamp").at("card_source"), "tags");
  EXPECT_GT(std::filesystem::file_size(page), 20'000u);

  // Without the steps the errors are those of the bench, five times and more.
  const json blind = calibrated(session + " --without lens,vignetting,pose,card_pose,lamp_drift,lamp_pattern");
  for (const char* what : {"irradiance_error", "pose_error_mm", "pose_error_deg"}) {
    EXPECT_GT(figure(blind, what, "median"), 5.0 * figure(result, what, "median")) << what;
  }
  EXPECT_EQ(run_program("calibrate " + session + " --without nothing").exit_code, 2);
}

std::string lens_plan(const TemporaryFolder& folder, int placements) {
  const std::string path = (folder / ("lens" + std::to_string(placements) + ".toml")).string();
  std::ofstream(path) << "name = \"lens\"\ngain_db = 0.0\ndarks_per_exposure = 2\n[lens]\nboard_s = 0.02\nboard_placements = "
                      << placements << "\n";
  return path;
}

TEST(CalibratedSession, ALensCalibrationIsCarriedOnAndChecked) {
  const TemporaryFolder folder;
  const std::string first = (folder / "first").string(), lens = (folder / "lens.json").string();
  const ProgramRun capture = run_program("capture " + kRig + " " + lens_plan(folder, 8) + " --out " + first);
  ASSERT_EQ(capture.exit_code, 0) << capture.errors;
  const json made = calibrated(first + " --lens-out " + lens);
  EXPECT_EQ(made.at("lens").at("source"), "boards of this session");
  EXPECT_TRUE(std::filesystem::exists(lens));

  const std::string second = (folder / "second").string();
  const ProgramRun check =
      run_program("capture " + kRig + " " + lens_plan(folder, 3) + " --lens " + lens + " --out " + second);
  ASSERT_EQ(check.exit_code, 0) << check.errors;
  const json held = calibrated(second);
  EXPECT_EQ(held.at("lens").at("source").get<std::string>().find("lens calibration "), 0u) << held.at("lens");
  EXPECT_EQ(held.at("camera").at("params"), made.at("camera").at("params"));

  // The lens was refocused: half a percent is noticed, and the calibration is not used.
  std::ofstream(folder / "refocused.toml") << "base = \"" << kRig << "\"\n[simulation]\nlens_focal_error = 0.01\n";
  const std::string third = (folder / "third").string();
  const ProgramRun refocused = run_program("capture " + (folder / "refocused.toml").string() + " " + lens_plan(folder, 3) +
                                           " --lens " + lens + " --out " + third);
  ASSERT_EQ(refocused.exit_code, 0) << refocused.errors;
  EXPECT_EQ(calibrated(third).at("lens").at("source"), "rig description");
  EXPECT_EQ(run_program("capture " + kSource + "/config/rigs/loopback_still_camera.toml " + lens_plan(folder, 3) +
                        " --lens missing.json --out " + third + "x").exit_code, 2);
}

}  // namespace
}  // namespace lumitexel
