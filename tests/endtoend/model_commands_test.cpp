// mip, export, report and view: what they write, and that everything is as it was where they cannot.
#include <gmock/gmock.h>

#include <algorithm>

#include "processing/image/exr_file.h"
#include "tests/endtoend/model_folder.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

// The most samples of a texel that a picture of a level shows.
float most_samples(const std::string& model, int level, const fs::path& out) {
  const ProgramRun run = run_program("render " + model + " --camera \"4,0,0;0,0,0;0,0,1;30;16x12\" --aov samples --level " + std::to_string(level) +
                                     " --out " + out.string());
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  const std::vector<float> samples = read_exr(out).planes.at(0).data;
  return *std::max_element(samples.begin(), samples.end());
}

TEST(Mip, ItsLevelsTakeThePlaceOfEarlierOnesAndRenderShowsThem) {
  const TemporaryFolder folder;
  const std::string model = written_sphere(folder);
  const ProgramRun mip = run_program("mip " + model + " --levels 2 --json");
  ASSERT_EQ(mip.exit_code, 0) << mip.errors;
  EXPECT_EQ(mip.json().at("way"), "averaged");
  ASSERT_EQ(mip.json().at("levels").size(), 2u);
  const nlohmann::json second = mip.json().at("levels")[1];
  EXPECT_EQ(second, (nlohmann::json{{"level", 2}, {"width", 4}, {"height", 2}, {"folder", model + "/levels/2"}}));
  EXPECT_EQ(most_samples(model, 0, folder / "own.exr"), 7.0f);
  EXPECT_EQ(most_samples(model, 2, folder / "second.exr"), 16 * 7.0f) << "of 4 x 4 texels together";

  ASSERT_EQ(run_program("mip " + model + " --levels 1").exit_code, 0);
  const ProgramRun gone = run_program("render " + model + " --camera \"4,0,0;0,0,0;0,0,1;30;16x12\" --light 4,0,0 --level 2 --out " + (folder / "x.exr").string());
  EXPECT_EQ(gone.exit_code, 2) << "of the earlier run";
  EXPECT_THAT(gone.errors, HasSubstr("`lumitexel mip " + model + " --levels 2`"));
  EXPECT_FALSE(fs::exists(folder / "x.exr"));
}

TEST(Mip, WithoutRoomTheEarlierLevelsStay) {
  const TemporaryFolder folder;
  const std::string model = written_sphere(folder);
  ASSERT_EQ(run_program("mip " + model + " --levels 1").exit_code, 0);
  const auto before = files_below(folder.path());
  const ProgramRun full = run_program("mip " + model + " --levels 3", disk_of(2));
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.errors, HasSubstr("cannot be written: File too large"));
  EXPECT_TRUE(files_below(folder.path()) == before);
}

TEST(Export, IsThereAsAWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string model = written_sphere(folder), out = (folder / "out").string();
  const auto before = files_below(folder.path());
  const ProgramRun full = run_program("export " + model + " --to gltf --out " + out, disk_of(4));
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.errors, HasSubstr("File too large"));
  EXPECT_TRUE(files_below(folder.path()) == before);

  const ProgramRun run = run_program("export " + model + " --to gltf --out " + out + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.json().at("to"), "gltf");
  EXPECT_GT(run.json().at("loss").at("psnr_db").get<double>(), 30.0) << "matte, as the format can be";
  for (const char* file : {"model.gltf", "model.bin", "base.png"}) EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
  const ProgramRun again = run_program("export nowhere --to gltf --out " + out);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.errors, HasSubstr("--out: '" + out + "' exists")) << "said before the model is read";
}

TEST(View, SaysWhatItWroteBesideTheModel) {
  const TemporaryFolder folder;
  const std::string model = written_sphere(folder);
  const ProgramRun run = run_program("view " + model + "/ --json");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.json().at("out"), model + ".html");
  EXPECT_EQ(run.json().at("bytes"), fs::file_size(model + ".html"));
  EXPECT_EQ(run.json().at("texels"), 16 * 8);
  EXPECT_EQ(run.json().at("every"), 0) << "no session, no samples";
}

// Pages have a usual place, which is looked at before the work as one given is.
TEST(Pages, WhereTheUsualPlaceIsTakenByAFolderThatIsSaid) {
  const TemporaryFolder folder;
  const std::string model = written_sphere(folder);
  fs::create_directory(folder / "model" / "report.html");
  fs::create_directory(folder / "model.html");
  for (const std::string command : {"report", "view"}) {
    // Were the session looked at first, that it is missing would be said.
    const ProgramRun run = run_program(command + " " + model + " --session nowhere");
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_THAT(run.errors, HasSubstr(".html is a folder; expected a file")) << command;
  }
}

}  // namespace
}  // namespace lumitexel
