// render: light between surfaces that the fit took out, and Ctrl-C.
#include <gmock/gmock.h>

#include <csignal>
#include <numeric>

#include "processing/image/exr_file.h"
#include "tests/endtoend/model_folder.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;
using testing::Not;

// SmallImport's cameras look along +z from z = -2: a plate that faces them, and a wall at its right that faces left.
Mesh corner_mesh() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {1, 1, -2}, {1, -1, -2}};
  for (int v = 0; v < 8; ++v) {
    mesh.normals.push_back(v < 4 ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(-1, 0, 0));
    mesh.texcoords.emplace_back(0.5, 0.5);
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return mesh;
}

double sum_of(const std::filesystem::path& picture) {
  double sum = 0.0;
  for (const ExrPlane& plane : read_exr(picture).planes) sum = std::accumulate(plane.data.begin(), plane.data.end(), sum);
  return sum;
}

class BouncedLight : public testing::Test {
 protected:
  BouncedLight() {
    Model model = model_of(corner_mesh(), 4, 4, diffuse_brdf(0.25, 0.25, 0.25));
    model.indirect_bounces = 2;
    model.indirect = Image(4, 4, 2, 0.1f);
    write_model(model_, model);
  }

  ProgramRun rendered(const std::string& options) const {
    const ProgramRun run = run_program("render " + model_ + " --json --out " + out_ + " " + options);
    EXPECT_EQ(run.exit_code, 0) << options << '\n' << run.errors;
    return run;
  }

  SmallImport photographs_;
  std::string session_ = imported(photographs_, "session"), model_ = photographs_.path("model").string(), out_ = photographs_.path("out.exr").string();
  std::string photograph_ = "--session " + session_ + " --view c";
};

TEST_F(BouncedLight, IsInAPhotographsPictureUnlessToldOtherwise) {
  const ProgramRun usual = rendered(photograph_);
  EXPECT_EQ(usual.json().at("bounces"), 2);
  EXPECT_THAT(usual.errors, Not(HasSubstr("note")));
  const double with = sum_of(out_);
  const ProgramRun straight = rendered(photograph_ + " --bounces 0");
  EXPECT_EQ(straight.json().at("bounces"), 0);
  EXPECT_THAT(straight.errors, Not(HasSubstr("note"))) << "as told";
  EXPECT_GT(with, 1.05 * sum_of(out_));
  const ProgramRun sampled = rendered(photograph_ + " --spp 64");
  EXPECT_EQ(sampled.json().at("bounces"), 2);
  // Two percent: the noise of 8 paths in each of 192 pixels is a tenth of that; a pixel's centre is not its mean.
  EXPECT_NEAR(sum_of(out_), with, 0.02 * with);
}

TEST_F(BouncedLight, IsMissedByNameInOtherPictures) {
  const std::string camera = "--camera \"0,0,-2;0,0,0;0,1,0;30;16x12\" --light 0,1,-2";
  for (const std::string& other : {camera, photograph_ + " --splat"}) {
    const ProgramRun run = rendered(other);
    EXPECT_EQ(run.json().at("bounces"), 0) << other;
    EXPECT_THAT(run.errors, HasSubstr("--bounces 2")) << other;
  }
  EXPECT_THAT(rendered(camera + " --bounces 2 --spp 2").errors, Not(HasSubstr("note:")));
}

// Light that no time or noise ends; the picture of n passes is a function of n.
TEST(Render, OnCtrlCThePictureSoFarIsWritten) {
  const TemporaryFolder folder;
  const std::string so_far = (folder / "so_far.exr").string(), counted = (folder / "counted.exr").string(), preview = (folder / "preview.png").string();
  const std::string render = "render " + written_sphere(folder) + " --camera \"4,0,0;0,0,0;0,0,1;30;16x12\" --light 4,1,0 --bounces 1 --json --out ";
  const ProgramRun stopped = run_program_until(render + so_far + " --noise 1e-9 --png " + preview, "Ctrl-C ends", SIGINT);
  EXPECT_EQ(stopped.exit_code, 1) << stopped.errors;
  ASSERT_FALSE(stopped.output.empty()) << stopped.errors;
  EXPECT_EQ(stopped.json().at("ended_by"), "stopped");
  EXPECT_THAT(stopped.errors, HasSubstr("stopping once what is under way is done"));
  EXPECT_TRUE(std::filesystem::exists(preview));
  const int samples = stopped.json().at("samples_per_pixel").get<int>();
  ASSERT_EQ(run_program(render + counted + " --spp " + std::to_string(samples)).exit_code, 0);
  EXPECT_EQ(read_whole_file(so_far), read_whole_file(counted));
}

}  // namespace
}  // namespace lumitexel
