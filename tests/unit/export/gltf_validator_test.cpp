// Khronos' validator on what is written.
#include <gtest/gtest.h>

#include "processing/export/export_model.h"
#include "tests/unit/export/odd_models.h"
#include "tests/unit/export/outside_checker.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::string kValidator = "gltf_validator";

void expect_valid(const Model& model) {
  const TemporaryFolder folder;
  NoProgress quiet;
  export_model(model, ExportFormat::Gltf, folder / "gltf", quiet);
  const CheckerAnswer answer = checked_by(kValidator, folder / "gltf");
  EXPECT_TRUE(answer.passed) << answer.said;
}

TEST(GltfValidator, HasNeitherErrorsNorWarnings) {
  SKIP_WITHOUT_CHECKER(kValidator);
  expect_valid(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05)));
}

TEST(GltfValidator, NeitherWithNormalsAndTangents) {
  SKIP_WITHOUT_CHECKER(kValidator);
  expect_valid(with_own_normals(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05))));
}

TEST(GltfValidator, NeitherWithHighlightsNorWithSurfaceThatNobodySaw) {
  SKIP_WITHOUT_CHECKER(kValidator);
  expect_valid(glossy_model());
  expect_valid(partly_unseen_model());
}

TEST(GltfValidator, SeesAFileThatIsBroken) {
  SKIP_WITHOUT_CHECKER(kValidator);
  const TemporaryFolder folder;
  NoProgress quiet;
  export_model(model_of(sphere_mesh(24, 12), 4, 4, diffuse_brdf(0.2, 0.1, 0.05)), ExportFormat::Gltf, folder / "gltf", quiet);
  std::filesystem::resize_file(folder / "gltf/model.bin", 100);
  const CheckerAnswer answer = checked_by(kValidator, folder / "gltf");
  EXPECT_FALSE(answer.passed) << answer.said;
  EXPECT_NE(answer.said.find("BUFFER"), std::string::npos) << answer.said;
}

}  // namespace
}  // namespace lumitexel
