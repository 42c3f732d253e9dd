#include "processing/calibration/import/code_response.h"

#include <gtest/gtest.h>

#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

CodeResponse curve(const std::string& text) { return CodeResponse::from_csv(text, "r.csv"); }

TEST(CodeResponse, LinearAndSrgbHaveTheirKnownValues) {
  EXPECT_EQ(CodeResponse::linear().radiance(0.3), 0.3);
  const CodeResponse srgb = CodeResponse::srgb();
  EXPECT_EQ(srgb.radiance(0.0), 0.0);
  EXPECT_NEAR(srgb.radiance(1.0), 1.0, 1e-15);
  // The standard's code 188 of 255 for half the light, as tables have it to three places.
  EXPECT_NEAR(srgb.radiance(188.0 / 255.0), 0.503, 5e-4);
  // Its two pieces meet to the rounding of the standard's constants.
  EXPECT_NEAR(srgb.radiance(0.04045), srgb.radiance(0.0404501), 1e-6);
}

TEST(CodeResponse, ACurveIsLinearBetweenItsPointsAndExactAtThem) {
  const CodeResponse response = curve("code,linear\n# measured\n0,0.01\n0.5, 0.1\n1,2\n");
  EXPECT_DOUBLE_EQ(response.radiance(0.0), 0.01);
  EXPECT_DOUBLE_EQ(response.radiance(0.25), 0.055);
  EXPECT_DOUBLE_EQ(response.radiance(0.5), 0.1);
  EXPECT_DOUBLE_EQ(response.radiance(0.75), 1.05);
  EXPECT_DOUBLE_EQ(response.radiance(1.0), 2.0);
}

TEST(CodeResponse, CurvesThatCannotBeUsedAreNamed) {
  EXPECT_BAD_INPUT(curve("0,0\n0.5,0.6\n1,0.5\n"), "r.csv:3: linear");
  EXPECT_BAD_INPUT(curve("0,0\n0.5,0.6\n0.5,0.7\n1,1\n"), "r.csv:3: code");
  EXPECT_BAD_INPUT(curve("0,0\n0.9,1\n"), "r.csv: code", "from 0 to 1");
  EXPECT_BAD_INPUT(curve("0.1,0\n1,1\n"), "r.csv: code", "from 0 to 1");
  EXPECT_BAD_INPUT(curve("0,-0.1\n1,1\n"), "r.csv:1: linear");
  EXPECT_BAD_INPUT(curve("0,1\n1,1\n"), "r.csv: linear", "flat");
  EXPECT_BAD_INPUT(curve("0,0\n1\n"), "r.csv:2", "1 fields");
  EXPECT_BAD_INPUT(curve("0,0\n1,nan\n"), "r.csv:2: linear", "nan");
  EXPECT_BAD_INPUT(curve(""), "r.csv");
}

}  // namespace
}  // namespace lumitexel
