// Photographs made by an unrelated renderer, through import, fit and evaluate.
#include <gtest/gtest.h>

#include "tests/endtoend/run_program.h"
#include "tests/unit/shared_data.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

TEST(ImportedSession, BecomesAModelThatPredictsHeldOutPhotographs) {
  SKIP_WITHOUT_SHARED_DATA("oracle_a");
  const std::string oracle = (shared_data() / "oracle_a").string();
  const TemporaryFolder folder;
  const std::string session = (folder / "session").string(), model = (folder / "model").string();

  const ProgramRun import = run_program("import --colmap " + oracle + " --images " + oracle + "/images --lights " + oracle +
                                        "/lights.csv --mesh " + oracle + "/mesh.ply --masks " + oracle +
                                        "/masks --out " + session + " --json");
  ASSERT_EQ(import.exit_code, 0) << import.errors;
  EXPECT_EQ(import.json().at("views"), 30);

  const ProgramRun fit = run_program("fit " + session + " --out " + model + " --quality draft --materials 6 --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.errors;

  const ProgramRun evaluate = run_program("evaluate " + model + " " + session + " --json");
  ASSERT_EQ(evaluate.exit_code, 0) << evaluate.errors;
  const auto heldout = evaluate.json().at("heldout_by_stage");
  for (const char* measure : {"relative_rms", "clipped_rms", "sqrt_rms"}) {
    const auto error = [&](const char* stage) { return heldout.at(stage).at(measure).get<double>(); };
    EXPECT_LT(error("cluster"), error("single")) << measure;
    EXPECT_LE(error("projection"), error("cluster")) << measure;
  }
  // A prototype on the same data reached 0.24 on square roots; a tenth more would mean that something broke.
  EXPECT_LT(heldout.at("projection").at("sqrt_rms").get<double>(), 0.264);
}

}  // namespace
}  // namespace lumitexel
