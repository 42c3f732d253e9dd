// What the program answers to someone who does not know it: every message names what was wrong and what would be right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/endtoend/run_program.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;

// Exits with 2 and one line that says all of `parts`.
void expect_refused(const std::string& arguments, const std::vector<std::string>& parts) {
  const ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.exit_code, 2) << arguments;
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  for (const std::string& part : parts) EXPECT_THAT(run.errors, HasSubstr(part)) << arguments;
}

// By the option parser, which adds a line that points to the help.
void expect_value_refused(const std::string& arguments, const std::string& start) {
  const ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.exit_code, 2) << arguments;
  EXPECT_THAT(run.errors, testing::StartsWith(start));
}

std::string help_of(const std::string& command) {
  const ProgramRun run = run_program(command + " --help");
  EXPECT_EQ(run.exit_code, 0) << command;
  return run.output;
}

TEST(Usage, AnUnknownCommandIsNamedAndTheKnownOnesListed) {
  expect_refused("photograph S", {"'photograph'", "capture", "evaluate"});
  expect_refused("--json photograph", {"'photograph'"});
}

// Only what tells the folders apart is looked at, so that these need not be whole.
TEST(Usage, AFolderOfTheWrongKindIsCalledWhatItIs) {
  const TemporaryFolder folder;
  for (const char* name : {"session", "model", "empty", "other"}) std::filesystem::create_directory(folder / name);
  std::ofstream(folder / "session" / "session.db") << '\n';
  std::ofstream(folder / "model" / "model.json") << '\n';
  std::ofstream(folder / "other" / "notes.txt") << '\n';
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const std::string session = at("session"), model = at("model"), out = at("out");

  expect_refused("evaluate " + session + " " + session, {"MODEL", session, "is a session", "expected the folder of a model"});
  expect_refused("report " + session, {"MODEL", "is a session"});
  for (const std::string& command :
       {"calibrate " + model, "fit " + model + " --out " + out, "tradeoff " + model, "verify " + model, "resume " + model, "replay " + model + " --out " + out}) {
    expect_refused(command, {"SESSION", model, "is a model", "expected the folder of a session"});
  }
  expect_refused("verify " + at("empty"), {"is an empty folder"});
  expect_refused("verify " + at("other"), {"is a folder that holds notes.txt"});
  expect_refused("verify " + at("missing"), {"does not exist"});
  expect_refused("render " + at("other") + " --out x.exr --camera '0,0,1;0,0,0;0,1,0;30;4x4' --light 0,0,1", {"MODEL", "notes.txt"});
}

// Damaged input is bad input, whichever command meets it.
TEST(Usage, ADamagedJournalIsNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "session");
  std::ofstream(folder / "session" / "session.db") << std::string(5000, 'x');
  const std::string session = (folder / "session").string(), out = (folder / "out").string();
  for (const std::string& command : {"verify " + session, "fit " + session + " --out " + out, "calibrate " + session, "replay " + session + " --out " + out}) {
    expect_refused(command, {"session.db"});
  }
}

TEST(Usage, WhereNothingCanBeWrittenIsSaidBeforeTheWork) {
  const TemporaryFolder folder;
  const std::string here = folder.path().string(), nowhere = (folder / "missing" / "x").string();
  for (const std::string& out : {here, nowhere}) {
    expect_refused("view M --out " + out, {"--out", "expected a file"});
    expect_refused("calibrate S --page " + out, {"--page", "expected a file"});
    expect_refused("calibrate S --lens-out " + out, {"--lens-out", "expected a file"});
    expect_refused("report M --page " + out, {"--page", "expected a file"});
    expect_refused("render M --camera '0,0,1;0,0,0;0,1,0;30;4x4' --light 0,0,1 --out " + out, {"--out", "expected a file"});
  }
  expect_refused("fit S --out ''", {"--out", "no name"});
}

TEST(Usage, RenderRefusesWhatItWouldNotShow) {
  const std::string render = "render M --session S --view v --out x.exr ";
  expect_refused(render + "--level 2 --stage cluster", {"--stage: cluster with --level 2", "the last stage alone"});
  expect_refused(render + "--level 2 --aov normal-sigma", {"--aov: normal-sigma with --level 2", "no --level"});
  for (const char* idle : {"--png x.png", "--stage cluster", "--bounces 1", "--splat"}) {
    expect_refused(render + "--aov normal " + idle, {"--aov: 'normal' with", "radiance only"});
  }
}

TEST(Usage, AWrongValueIsAnsweredWithItsOptionAndTheRightOnes) {
  expect_refused("fit S --out M --family blinn", {"--family: 'blinn'", "lafortune, ggx, ward or auto"});
  expect_refused("fit S --out M --quality fine", {"--quality: 'fine'", "draft, standard or reference"});
  expect_refused("fit S --out M --errors none", {"--errors: 'none'", "auto, given, labels or estimated"});
  expect_refused("fit S --out M --plain-projection --principal-functions", {"--principal-functions", "--plain-projection"});
  expect_refused("fit S --out M --method paper --quality reference --family ggx", {"--family: ggx with --method paper", "lafortune"});
  expect_refused("fit S --out M --intensity-weight 0.5", {"--intensity-weight", "--method paper"});
  expect_refused("fit S --out M --lobes 0 --family ggx", {"--lobes: 0 with --family", "1 to 3"});
  expect_refused("fit S --out M --method ours", {"--method: 'ours'", "lumitexel or paper"});
  expect_refused("calibrate S --without x", {"--without: 'x'", "photon_transfer", "lamp_pattern"});
  expect_refused("calibrate S --without lens,x", {"--without: 'x'"});
  expect_refused("render M --session S --view v --out x.exr --aov depth", {"--aov: 'depth'", "normal", "sigma"});
  expect_refused("tradeoff S --only x", {"--only: 'x'", "views-16"});
  expect_refused("tradeoff S --page nowhere/p.html", {"--page", "nowhere", "no folder"});
  expect_refused("fit S --out M --interreflections x", {"--interreflections: 'x'", "auto, always or off"});
  expect_refused("tradeoff S --materials many", {"--materials: 'many'", "or auto"});
  expect_refused("tradeoff S --materials auto --only paper", {"--materials"});
  expect_refused("experiment --auto --materials 4", {"--auto", "with --materials"});
  expect_refused("experiment --paper --method paper", {"--paper", "with --method"});
  expect_refused("experiment --only x", {"--only: 'x'", "'even, Gaussian noise'"});
}

TEST(Usage, AWrongNumberIsAnsweredWithTheRightOnes) {
  for (const std::string wrong : {"4", "-1", "two", "1.5", "nan"}) {
    expect_value_refused("fit S --out M --lobes " + wrong, "--lobes: expected a whole number from 0 to 3, got '" + wrong + "'");
  }
  for (const std::string wrong : {"0", "1.5", "nan", "inf", "0.5x"}) {
    expect_value_refused("fit S --out M --method paper --intensity-weight " + wrong,
                         "--intensity-weight: expected a finite number from 0.001 to 1, got '" + wrong + "'");
  }
  for (const char* decimal : {"08", "+8"}) expect_refused("fit S --out M --draw " + std::string(decimal), {"SESSION: S does not exist"});
  for (const std::string wrong : {"0", "nan", "inf"}) {
    expect_value_refused("simulate R --for " + wrong, "--for: expected a finite number above 0, got '" + wrong + "'");
  }
}

TEST(Usage, OldNamesOfOptionsStillAct) {
  for (const char* both : {"--method paper --materials auto", "--paper --materials auto", "--method paper --auto", "--paper --auto"}) {
    expect_refused(std::string("experiment --seeds 1 ") + both, {"--materials: auto with --method paper"});
  }
  expect_refused("tradeoff S --full", {"SESSION: S does not exist"});
  expect_refused("report M --page x.html", {"MODEL: M does not exist"});
}

TEST(Usage, HelpSaysWhatOptionsTakeAndThatEveryCommandHasJson) {
  for (const char* command : {"commission", "plan", "simulate", "capture", "resume", "verify", "replay", "import", "calibrate", "fit",
                              "experiment", "render", "mip", "evaluate", "tradeoff", "export", "report", "view", "selftest"}) {
    EXPECT_THAT(help_of(command), HasSubstr("--json")) << command;
  }
  for (const char* name : {"draft", "learning-5000", "errors-given", "views-8", "reference"}) EXPECT_THAT(help_of("tradeoff"), HasSubstr(name));
  for (const char* name : {"'even, uniform noise'", "'uneven, uniform, 2 % outliers'"}) EXPECT_THAT(help_of("experiment"), HasSubstr(name));
  for (const char* step : {"photon_transfer (", "dark_scale (", "lamp_pattern ("}) EXPECT_THAT(help_of("calibrate"), HasSubstr(step));
}

TEST(Usage, JsonMayStandBeforeTheCommandAndAfterIt) {
  for (const char* arguments : {"--json verify nowhere", "verify --json nowhere", "verify nowhere --json"}) {
    expect_refused(arguments, {"nowhere does not exist"});
  }
}

}  // namespace
}  // namespace lumitexel
