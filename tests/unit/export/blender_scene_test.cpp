// The exported scene rendered by Blender, if there is one, and compared with the model's own rendering.
#include <gtest/gtest.h>

#include <cstdlib>

#include "processing/export/export_model.h"
#include "processing/image/exr_file.h"
#include "rig/whole_file.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

Brdf glossy() { return with_ggx_lobe(diffuse_brdf(0.12, 0.08, 0.04), 0.15, 0.5); }

double psnr_in_blender_db(const Model& model) {
  const TemporaryFolder folder;
  NoProgress quiet;
  const std::filesystem::path out = folder / "scene";
  export_model(model, ExportFormat::Blender, out, quiet);
  const std::string command = "blender -b --python-exit-code 9 --python " + (out / "scene.py").string() + " -- " + (folder / "blender.exr").string() +
                              " >" + (folder / "log").string() + " 2>&1";
  if (std::system(command.c_str()) != 0) return -1.0;
  const Image ours = read_exr_colour(out / "reference.exr"), theirs = read_exr_colour(folder / "blender.exr");
  std::vector<std::uint8_t> counted;
  for (std::size_t p = 0; p < ours.data.size(); p += 3) counted.push_back(ours.data[p] + ours.data[p + 1] + ours.data[p + 2] > 0.0f ? 1 : 0);
  ErrorSums sums;
  sums.add(theirs, ours, counted);
  std::printf("Blender against the model's own rendering: PSNR %.1f dB\n", sums.error().psnr_db);
  char said[80];  // what the scene says of itself
  std::snprintf(said, sizeof said, "PSNR against reference.exr: %.1f dB", sums.error().psnr_db);
  EXPECT_NE(read_whole_file(folder / "log").find(said), std::string::npos) << said;
  return sums.error().psnr_db;
}

#define SKIP_WITHOUT_BLENDER() \
  if (std::system("command -v blender >/dev/null") != 0) GTEST_SKIP() << "BLENDER MISSING: the exported scene is not rendered by it, so this is not tested"

TEST(BlenderScene, BlenderSeesWhatTheModelShows) {
  SKIP_WITHOUT_BLENDER();
  // 16 samples, 8 bits and the diffuse light's fall at grazing angles are left (58.7 dB); a lamp a tenth too bright would give 33 dB at most.
  EXPECT_GT(psnr_in_blender_db(model_of(sphere_mesh(80, 40), 16, 8, glossy())), 50.0);
}

TEST(BlenderScene, BlenderSeesTheTexelsOwnNormals) {
  SKIP_WITHOUT_BLENDER();
  Model model = model_of(sphere_mesh(80, 40), 160, 80, glossy());
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 160; ++x) {
      const double longitude = 2.0 * std::numbers::pi * (x + 0.5) / 160, latitude = std::numbers::pi * (0.5 - (y + 0.5) / 80);
      Eigen::Vector3d normal(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
      normal = (normal + 0.2 * Eigen::Vector3d(std::sin(0.3 * x), std::cos(0.25 * y), std::sin(0.2 * y))).normalized();
      for (int k = 0; k < 3; ++k) model.normal.at(x, y, k) = static_cast<float>(normal[k]);
    }
  }
  EXPECT_GT(psnr_in_blender_db(model), 37.0);  // 42.5: Blender bends normals that would mirror the view into the surface; ours stay
}

}  // namespace
}  // namespace lumitexel
