// From plan to report on the simulated rig, at half its resolution so that it takes under a minute.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/endtoend/run_program.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::string kSource = LUMITEXEL_SOURCE_DIR;

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << "the bench no longer says '" << from << "'";
  text.replace(at, from.size(), to);
}

// The shipped bench with a camera of half the width and height.
std::string half_bench() {
  std::string text = text_of(kSource + "/config/rigs/simulated.toml");
  replace(text, "width_px = 1024", "width_px = 512");
  replace(text, "height_px = 768", "height_px = 384");
  replace(text, "focal_px = [2950.0, 2950.0]", "focal_px = [1475.0, 1475.0]");
  replace(text, "principal_px = [516.3, 379.8]", "principal_px = [258.15, 189.9]");
  return text;
}

// Killed without warning after some seconds, then gone on with.
void capture_through_a_kill(const std::string& rig, const std::string& session) {
  const ProgramRun killed = run_program("capture " + rig + " --out " + session, "timeout -s KILL 8 ");
  const bool begun = std::filesystem::exists(session);  // a slow machine may not have come so far
  const ProgramRun rest = run_program(begun ? "resume " + session : "capture " + rig + " --out " + session);
  ASSERT_EQ(rest.exit_code, 0) << rest.errors;
  if (killed.exit_code != 0 && begun) {
    EXPECT_LT(run_program("resume " + session + " --json").json().at("taken").get<int>(), 1);  // nothing is left to take
  }
}

std::map<std::string, std::string> frames_of(const std::filesystem::path& session) {
  std::map<std::string, std::string> frames;
  for (const auto& entry : std::filesystem::directory_iterator(session / "frames")) {
    frames[entry.path().filename().string()] = text_of(entry.path());
  }
  return frames;
}

// Rays and points, lamps and a sky (any picture of light will do: the model's own), on the model's mesh handed in again.
void expect_pictures(const TemporaryFolder& folder, const std::string& model) {
  const std::string sky = (folder / "sky.exr").string(), out = (folder / "out.exr").string();
  const std::string render = "render " + model + " --camera \"0.4,0.3,0.3;0,0,0.05;0,0,1;30;48x32\" --json ";
  const ProgramRun plain = run_program(render + "--light 0.5,-0.2,0.6 --out " + sky);
  ASSERT_EQ(plain.exit_code, 0) << plain.errors;
  EXPECT_FALSE(plain.json().contains("noise")) << "one lamp: nothing is left to chance";
  const ProgramRun moved = run_program(render + "--light 0.5,-0.2,0.6 --mesh " + model + "/mesh.ply --out " + out);
  ASSERT_EQ(moved.exit_code, 0) << moved.errors;
  EXPECT_TRUE(text_of(out) == text_of(sky)) << "the model's own mesh changes nothing";
  const ProgramRun lit = run_program(render + "--environment " + sky + " --directional 0,0,1 --bounces 1 --spp 3 --out " + out);
  ASSERT_EQ(lit.exit_code, 0) << lit.errors;
  EXPECT_EQ(lit.json().at("samples_per_pixel"), 3);
  EXPECT_EQ(lit.json().at("ended_by"), "samples");
  EXPECT_GT(lit.json().at("noise").get<double>(), 0.0);
  const ProgramRun limited = run_program(render + "--environment " + sky + " --noise 0.2 --time-limit 60 --out " + out);
  ASSERT_EQ(limited.exit_code, 0) << limited.errors;
  EXPECT_EQ(limited.json().at("ended_by"), "noise") << limited.output;
  const ProgramRun points = run_program(render + "--light 0.5,-0.2,0.6 --splat --out " + out);
  ASSERT_EQ(points.exit_code, 0) << points.errors;
  EXPECT_GT(points.json().at("points_shown").get<int>(), 1000);
  const std::string wrongs[] = {"--splat --environment " + sky,   "--light 0,0,1 --environment-scale 2", "--light 0,0,1 --bounces -1",
                                "--light 0,0,1 --mesh " + sky, "--light 0,0,1 --noise 0", ""};
  for (const std::string& wrong : wrongs) {
    EXPECT_EQ(run_program(render + wrong + " --out " + out).exit_code, 2) << wrong;
  }
}

// Played back whole, by the command and as a rig of its own, a session is the same; a shorter one is a session, too.
void expect_replays(const TemporaryFolder& folder, const std::string& session, const std::string& rig) {
  const auto frames = frames_of(session);
  const ProgramRun whole = run_program("replay " + session + " --out " + (folder / "whole").string() + " --json");
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_EQ(whole.json().at("frames"), frames.size());
  EXPECT_EQ(whole.json().at("missing"), 0);
  EXPECT_TRUE(frames_of(folder / "whole") == frames);

  std::ofstream(folder / "recorded.toml")
      << "base = \"bench.toml\"\nbackend = \"recorded\"\n[recorded]\nsession = \"session\"\n";
  const ProgramRun capture = run_program("capture " + (folder / "recorded.toml").string() + rig.substr(rig.find(' ')) +
                                         " --out " + (folder / "again").string());
  ASSERT_EQ(capture.exit_code, 0) << capture.errors;
  EXPECT_TRUE(frames_of(folder / "again") == frames);

  const std::string shorter = (folder / "shorter").string();
  const ProgramRun replay = run_program("replay " + session + " --out " + shorter + " --without view=8 --json");
  ASSERT_EQ(replay.exit_code, 0) << replay.errors;
  EXPECT_EQ(replay.json().at("left_out"), nlohmann::json{"fit_007"});
  for (const std::string& command : {"verify " + shorter, "calibrate " + shorter,
                                     "fit " + shorter + " --out " + shorter + "_model --quality draft --materials 2 --normals mesh",
                                     "evaluate " + shorter + "_model " + shorter}) {
    const ProgramRun run = run_program(command);
    EXPECT_EQ(run.exit_code, 0) << command << '\n' << run.errors;
    if (command.starts_with("fit")) {
      EXPECT_NE(run.output.find("What left-out samples said"), std::string::npos) << run.output;
      EXPECT_NE(run.output.find("chosen by left-out samples"), std::string::npos) << run.output;
    }
  }
  const ProgramRun unknown = run_program("replay " + session + " --out " + shorter + "2 --without view=99");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.errors.find("7 heldout_000 (held out)"), std::string::npos) << unknown.errors;
  EXPECT_FALSE(std::filesystem::exists(shorter + "2"));
}

TEST(CapturedSession, BecomesAModelThatPredictsAHeldOutPhotograph) {
  const TemporaryFolder folder;
  std::ofstream(folder / "bench.toml") << half_bench();
  const std::string rig = (folder / "bench.toml").string() + " " + kSource + "/config/plans/small.toml";
  const std::string session = (folder / "session").string(), model = (folder / "model").string();

  const ProgramRun plan = run_program("plan " + rig + " --json");
  ASSERT_EQ(plan.exit_code, 0) << plan.errors;
  EXPECT_GE(plan.json().at("estimate_s").get<double>(), plan.json().at("lower_bound_s").get<double>());
  EXPECT_FALSE(std::filesystem::exists(session));

  capture_through_a_kill(rig, session);
  const ProgramRun verify = run_program("verify " + session + " --json");
  ASSERT_EQ(verify.exit_code, 0) << verify.output;
  EXPECT_TRUE(verify.json().at("ok").get<bool>());
  EXPECT_EQ(verify.json().at("frames"), plan.json().at("shots"));

  const ProgramRun calibrate = run_program("calibrate " + session + " --json");
  ASSERT_EQ(calibrate.exit_code, 0) << calibrate.errors;
  // The goal of the whole rig, 5 mm at 1 m, though this camera has a quarter of its pixels.
  EXPECT_LT(calibrate.json().at("light_error_mm").at("max").get<double>(), 5.0);

  const ProgramRun fit = run_program("fit " + session + " --out " + model + " --quality draft --normals auto --materials 4 --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.errors;
  EXPECT_EQ(fit.json().at("materials"), 4);
  EXPECT_EQ(fit.json().at("options").at("most_lobes"), 2) << "as the preset has it";
  const auto choices = fit.json().at("choices");
  ASSERT_FALSE(choices.empty());
  EXPECT_EQ(choices[0].at("of"), "errors");
  EXPECT_EQ(choices[0].at("over"), "given");
  EXPECT_TRUE(choices[0].at("gain").is_number());

  const ProgramRun evaluate = run_program("evaluate " + model + " " + session + " --json");
  ASSERT_EQ(evaluate.exit_code, 0) << evaluate.errors;
  const auto rms = evaluate.json().at("rms");
  EXPECT_LT(rms.at("cluster").get<double>(), rms.at("single").get<double>());
  EXPECT_LT(rms.at("projection").get<double>(), rms.at("cluster").get<double>());
  EXPECT_TRUE(rms.at("pfa").is_null());
  const auto heldout = evaluate.json().at("heldout_by_stage");
  const auto error = [&](const char* stage) { return heldout.at(stage).at("relative_rms").get<double>(); };
  EXPECT_LT(error("cluster"), 0.9 * error("single"));
  EXPECT_LT(error("projection"), 1.02 * error("cluster"));  // one photograph: equal within what a few pixels decide

  expect_pictures(folder, model);
  expect_replays(folder, session, rig);

  const ProgramRun report = run_program("report " + model + " --session " + session);
  ASSERT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_GT(std::filesystem::file_size(std::filesystem::path(model) / "report.html"), 100'000u);
}

TEST(Program, BadUsageAndBadInputExitWithTwoAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::string out = (folder / "session").string();
  EXPECT_EQ(run_program("").exit_code, 2);
  EXPECT_EQ(run_program("photograph").exit_code, 2);
  EXPECT_EQ(run_program("--help").exit_code, 0);
  for (const std::string& arguments :
       {"plan missing.toml " + kSource + "/config/plans/small.toml",
        "capture " + kSource + "/config/rigs/simulated.toml missing.toml --out " + out,
        "fit " + out + " --out " + out + "_model", "render " + out + " --out x.exr", "verify " + out,
        "fit " + out + " --out " + out + "_model --materials many"}) {
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << '\n' << run.errors;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace lumitexel
