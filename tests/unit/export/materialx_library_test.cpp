// MaterialX's own library on what is written: read, validated, made a shader of.
#include <gtest/gtest.h>

#include "processing/export/export_model.h"
#include "rig/whole_file.h"
#include "tests/unit/export/odd_models.h"
#include "tests/unit/export/outside_checker.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::string kLibrary = "materialx_library";

Model sphere() { return model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05)); }

void write(const Model& model, const std::filesystem::path& folder) {
  NoProgress quiet;
  export_model(model, ExportFormat::Materialx, folder, quiet);
}

// The checker has to name what was damaged, so that no other failure passes for it.
void expect_refused(const std::filesystem::path& folder, const std::string& because) {
  const CheckerAnswer answer = checked_by(kLibrary, folder);
  EXPECT_FALSE(answer.passed) << answer.said;
  EXPECT_NE(answer.said.find(because), std::string::npos) << answer.said;
}

void expect_accepted(const Model& model, const std::vector<std::string>& textures) {
  const TemporaryFolder folder;
  write(model, folder / "mtlx");
  const CheckerAnswer answer = checked_by(kLibrary, folder / "mtlx");
  EXPECT_TRUE(answer.passed) << answer.said;
  EXPECT_NE(answer.said.find("lines of essl"), std::string::npos) << answer.said;
  for (const std::string& name : textures) EXPECT_NE(answer.said.find(name), std::string::npos) << name << ": " << answer.said;
}

TEST(MaterialxLibrary, MakesAShaderOfIt) {
  SKIP_WITHOUT_CHECKER(kLibrary);
  expect_accepted(sphere(), {"base.png", "specular.png", "specular_factor.png", "roughness.png"});
}

TEST(MaterialxLibrary, AlsoWithNormals) {
  SKIP_WITHOUT_CHECKER(kLibrary);
  expect_accepted(with_own_normals(sphere()), {"base.png", "normal.png"});
}

TEST(MaterialxLibrary, AlsoWithHighlightsAndWithSurfaceThatNobodySaw) {
  SKIP_WITHOUT_CHECKER(kLibrary);
  expect_accepted(glossy_model(), {"base.png", "specular.png", "roughness.png", "normal.png"});
  expect_accepted(partly_unseen_model(), {"base.png", "specular.png", "roughness.png", "normal.png"});
}

struct Damage {
  const char *text, *instead, *complaint;
};

constexpr Damage kDamages[] = {
    {"<multiply name=\"specular\" type=\"color3\">", "<multiplied name=\"specular\" type=\"color3\"/><multiply name=\"other\" type=\"color3\">",
     "nothing defines node specular, a multiplied"},
    {"\"metallic\"", "\"metalness\"", "Input 'metalness' doesn't match declaration"},
    {"output=\"base_out\"", "output=\"lost_out\"", "Invalid port connection"},
    {"\"srgb_texture\"", "\"srgb_picture\"", "nothing defines colour space srgb_picture"},
    {" colorspace=\"srgb_texture\"", "", "base.png is said to be coded as '', not 'srgb_texture'"},
    {"<input name=\"specular\" type=\"float\" nodegraph=\"textures\" output=\"specular_factor_out\"/>", "",
     "the shader does not sample specular_factor.png"},
};

// One export for all: it takes longer than the library does.
TEST(MaterialxLibrary, RefusesADamagedDocument) {
  SKIP_WITHOUT_CHECKER(kLibrary);
  const TemporaryFolder folder;
  write(sphere(), folder / "mtlx");
  const std::string whole = read_whole_file(folder / "mtlx/model.mtlx");
  for (const Damage& damage : kDamages) {
    std::string document = whole;
    const std::size_t at = document.find(damage.text);
    ASSERT_NE(at, std::string::npos) << "the export no longer writes " << damage.text;
    write_whole_file(folder / "mtlx/model.mtlx", document.replace(at, std::string(damage.text).size(), damage.instead));
    expect_refused(folder / "mtlx", damage.complaint);
  }
  write_whole_file(folder / "mtlx/model.mtlx", whole);
  std::filesystem::remove(folder / "mtlx/roughness.png");
  expect_refused(folder / "mtlx", "there is no texture roughness.png");
}

}  // namespace
}  // namespace lumitexel
