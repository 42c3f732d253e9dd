#include "processing/calibration/import/lights_csv.h"

#include <gtest/gtest.h>

#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

const std::string kHeader = "image,type,x,y,z,intensity_r,intensity_g,intensity_b";

std::vector<LightRow> parse(const std::string& text) { return parse_lights_csv(text, "l.csv"); }
std::vector<LightRow> parse_row(const std::string& row) { return parse(kHeader + "\n" + row + "\n"); }

TEST(LightsCsv, BothTypesAreRead) {
  const auto rows =
      parse(kHeader + "\r\na.exr,point,1,-2,3e0,10,11,12\r\n\r\n# note\r\nb.exr, directional, 0,0.6,0.8, 1,1,2\r\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].image, "a.exr");
  EXPECT_EQ(rows[0].light.type, Light::Type::Point);
  EXPECT_EQ(rows[0].light.vector_in_world, Eigen::Vector3d(1, -2, 3));
  EXPECT_EQ(rows[0].light.intensity, (std::vector<double>{10, 11, 12}));
  EXPECT_FALSE(rows[0].heldout);
  EXPECT_EQ(rows[1].light.type, Light::Type::Directional);
  EXPECT_EQ(rows[1].place, "l.csv:5");
}

TEST(LightsCsv, ColumnsMayStandInAnyOrderAndSplitIsRead) {
  const auto rows = parse(
      "split,image,x,y,z,type,intensity_b,intensity_g,intensity_r\nheldout,a,1,2,3,point,4,5,6\n"
      "fit,b,1,2,3,point,4,5,6\n");
  EXPECT_TRUE(rows[0].heldout);
  EXPECT_FALSE(rows[1].heldout);
  EXPECT_EQ(rows[0].light.intensity, (std::vector<double>{6, 5, 4}));
}

TEST(LightsCsv, ARoundedDirectionIsMadeUnit) {
  const auto rows = parse_row("a,directional,0.577,0.577,0.577,1,1,1");
  EXPECT_NEAR(rows[0].light.vector_in_world.norm(), 1.0, 1e-15);
}

TEST(LightsCsv, BadColumnsAreNamed) {
  EXPECT_BAD_INPUT(parse(kHeader + ",watts,colour\n"), "l.csv:1", "'watts', 'colour'");
  EXPECT_BAD_INPUT(parse("image,type,x,y,intensity_r,intensity_g,intensity_b\n"), "l.csv:1", "z", "no such column");
  EXPECT_BAD_INPUT(parse(kHeader + ",x\n"), "l.csv:1: x", "twice");
  EXPECT_BAD_INPUT(parse(""), "l.csv", "no light");
  EXPECT_BAD_INPUT(parse(kHeader + "\n"), "l.csv", "no light");
}

TEST(LightsCsv, BadRowsAreNamedByLineAndField) {
  EXPECT_BAD_INPUT(parse_row("a,point,1,2,3,4,5"), "l.csv:2", "7 fields");
  EXPECT_BAD_INPUT(parse_row("a,point,1,2,3,4,5,6,7"), "l.csv:2", "9 fields");
  EXPECT_BAD_INPUT(parse_row("a,spot,1,2,3,4,5,6"), "l.csv:2: type", "spot");
  EXPECT_BAD_INPUT(parse_row("a,point,1,2.0.0,3,4,5,6"), "l.csv:2: y", "2.0.0");
  EXPECT_BAD_INPUT(parse_row("a,point,1,nan,3,4,5,6"), "l.csv:2: y", "nan");
  EXPECT_BAD_INPUT(parse_row("a,point,1,2,,4,5,6"), "l.csv:2: z");
  EXPECT_BAD_INPUT(parse_row("a,point,1,2,3,4,0,6"), "l.csv:2: intensity_g", "above 0");
  EXPECT_BAD_INPUT(parse_row("a,directional,1,2,3,4,5,6"), "l.csv:2", "unit vector");
  EXPECT_BAD_INPUT(parse_row(",point,1,2,3,4,5,6"), "l.csv:2: image");
  EXPECT_BAD_INPUT(parse_row("a,point,1,2,3,4,5,6\na,point,1,2,3,4,5,6"), "l.csv:3: image", "twice");
  EXPECT_BAD_INPUT(parse(kHeader + ",split\na,point,1,2,3,4,5,6,test\n"), "l.csv:2: split", "fit or heldout");
}

}  // namespace
}  // namespace lumitexel
