#include "processing/report/viewer/viewer_section.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/temporary_folder.h"
#include "tests/viewer/browser_pictures.h"
#include "tests/viewer/bumpy_model.h"

namespace lumitexel {
namespace {

// Opens the section as a reader does, and tells what came up in its frame.
constexpr const char* kOpens = R"(<script>
document.getElementById("open-viewer").click();
(function wait() {
  const frame = document.querySelector("iframe"), inside = frame && frame.contentWindow;
  if (!inside || !inside.viewer || inside.viewer.frame_ms === undefined) return setTimeout(wait, 50);
  const stages = Array.from(inside.document.getElementById("stage").options, (option) => option.value);
  document.body.innerHTML = "<pre id=\"measured\"></pre>";
  document.getElementById("measured").textContent = JSON.stringify({ title: inside.document.title, stages });
})();
</script>)";

TEST(ViewerSection, OpensTheViewerInsideThePage) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to open the report with";
  const TemporaryFolder folder;
  std::ofstream(folder / "report.html", std::ios::binary)
      << "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"></head><body>" << viewer_section(viewer_page("a model", layered_model())) << kOpens << "</body></html>\n";
  const auto answer = browser_answer(folder / "report.html");
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->at("title"), "a model");
  EXPECT_EQ(answer->at("stages"), (nlohmann::json{"single", "cluster", "projection", "pfa", "normal"}));
}

TEST(ViewerSection, SaysSoWhereThePageIsTooLarge) {
  const ViewerPage page = viewer_page("a model", layered_model());
  EXPECT_NE(viewer_section(page).find("open-viewer"), std::string::npos);
  const std::string refused = viewer_section(page, 100'000);
  EXPECT_EQ(refused.find("open-viewer"), std::string::npos);
  EXPECT_NE(refused.find("lumitexel view"), std::string::npos);
  EXPECT_LT(refused.size(), 1000u);
  // Packing what is packed already must not make it grow.
  EXPECT_LT(viewer_section(page).size(), page.html.size());
}

// The last leaf may hold one triangle: 8 times its number plus one has to be a single-precision number.
TEST(ViewerPage, RefusesAMeshOfMoreTrianglesThanItsNumbersHold) {
  const auto held = [](std::size_t triangles) { return static_cast<std::size_t>(static_cast<float>(8 * (triangles - 1) + 1)) == 8 * (triangles - 1) + 1; };
  EXPECT_TRUE(held(kMostViewerTriangles));
  EXPECT_FALSE(held(kMostViewerTriangles + 1));
  Model model = layered_model();
  model.mesh.triangles.resize(kMostViewerTriangles + 1, model.mesh.triangles.front());
  EXPECT_BAD_INPUT(viewer_page("a model", model), "2097153 triangles", "2097152", "coarser mesh");
}

}  // namespace
}  // namespace lumitexel
