// Khronos' validator on what is written, where config/setup/install_gltf_validator.sh has put it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "processing/export/export_model.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::filesystem::path kRoot = LUMITEXEL_SOURCE_DIR;

#define SKIP_WITHOUT_VALIDATOR()                                                                                                        \
  if (std::system("command -v node >/dev/null") != 0 || !std::filesystem::exists(kRoot / "build/gltf_validator/node_modules/gltf-validator")) \
  GTEST_SKIP() << "GLTF VALIDATOR MISSING: run config/setup/install_gltf_validator.sh (needs node and npm); without it this is not tested"

int validated(const std::filesystem::path& folder, std::string& said) {
  const std::filesystem::path log = folder / "validator.log";
  const std::string command = "node " + (kRoot / "config/setup/gltf_validator/validate.js").string() + " " +
                              (kRoot / "build/gltf_validator/node_modules").string() + " " + folder.string() + " >" + log.string() + " 2>&1";
  const int status = std::system(command.c_str());
  std::ostringstream text;
  text << std::ifstream(log).rdbuf();
  said = text.str();
  return status;
}

void expect_valid(const Model& model) {
  const TemporaryFolder folder;
  NoProgress quiet;
  export_model(model, ExportFormat::Gltf, folder / "gltf", quiet);
  std::string said;
  EXPECT_EQ(validated(folder / "gltf", said), 0) << said;
}

TEST(GltfValidator, HasNeitherErrorsNorWarnings) {
  SKIP_WITHOUT_VALIDATOR();
  expect_valid(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05)));
}

TEST(GltfValidator, NeitherWithNormalsAndTangents) {
  SKIP_WITHOUT_VALIDATOR();
  Model model = model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05));
  for (std::size_t t = 0; t < model.normal.data.size(); ++t) model.normal.data[t] = t % 3 == 0 ? 1.0f : 0.0f;
  expect_valid(model);
}

TEST(GltfValidator, SeesAFileThatIsBroken) {
  SKIP_WITHOUT_VALIDATOR();
  const TemporaryFolder folder;
  NoProgress quiet;
  export_model(model_of(sphere_mesh(24, 12), 4, 4, diffuse_brdf(0.2, 0.1, 0.05)), ExportFormat::Gltf, folder / "gltf", quiet);
  std::filesystem::resize_file(folder / "gltf/model.bin", 100);
  std::string said;
  EXPECT_NE(validated(folder / "gltf", said), 0) << said;
}

}  // namespace
}  // namespace lumitexel
