#include "drivers/gphoto/exposure_choice.h"

#include <gtest/gtest.h>

#include "drivers/gphoto/frame_name.h"

namespace lumitexel {
namespace {

TEST(ExposureChoice, ReadsWhatCamerasWrite) {
  const std::vector<std::pair<std::string, double>> table{
      {"1/250", 0.004},     {"1/8000", 1.25e-4}, {"0.0040s", 0.004}, {"2.5", 2.5},         {"30", 30.0},
      {"30\"", 30.0},       {"1.3s", 1.3},       {"0,3", 0.3},       {"1 1/3", 4.0 / 3.0}, {"10/13", 10.0 / 13.0},
      {" 1/60 ", 1 / 60.0}, {"15 s", 15.0},      {"0.8 sec", 0.8},   {"1/2.5", 0.4}};
  for (const auto& [text, exposure_s] : table) {
    const auto parsed = parse_exposure_s(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_DOUBLE_EQ(*parsed, exposure_s) << text;
  }
}

TEST(ExposureChoice, TakesNothingElseForATime) {
  for (const char* text : {"", "bulb", "Time", "auto", "x 200", "0", "0.0000s", "1/0", "1/", "/250", "-1", "1/-2",
                           "nan", "inf", "1e-3", "30m", "1/250/2", "65535/65535x"}) {
    EXPECT_FALSE(parse_exposure_s(text)) << text;
  }
}

TEST(ExposureChoice, ReadsIsoValues) {
  EXPECT_EQ(parse_iso("100"), 100.0);
  EXPECT_EQ(parse_iso("ISO 25600"), 25600.0);
  for (const char* text : {"Auto", "Hi 1", "Lo 0.3", "0", "", "100 (auto)", "100-200"})
    EXPECT_FALSE(parse_iso(text)) << text;
}

TEST(ExposureChoice, FindsTheNearestThatIsMeant) {
  const std::vector<std::string> dial{"bulb", "30", "1/25", "1/30", "0.0333s", "1/40"};
  EXPECT_EQ(find_choice(dial, parse_exposure_s, 0.0333), "0.0333s");
  EXPECT_EQ(find_choice(dial, parse_exposure_s, 1.0 / 30.0), "1/30");
  EXPECT_EQ(find_choice(dial, parse_exposure_s, 29.9), "30");
  EXPECT_FALSE(find_choice(dial, parse_exposure_s, 0.03));
  EXPECT_FALSE(find_choice(dial, parse_exposure_s, 25.0));
  EXPECT_FALSE(find_choice({}, parse_exposure_s, 0.03));
}

TEST(FrameName, ComesBack) {
  for (const std::uint64_t key : {std::uint64_t{0}, std::uint64_t{42}, ~std::uint64_t{0}}) {
    EXPECT_EQ(frame_key_of(frame_name(key)), key);
    EXPECT_EQ(frame_key_of(frame_name(key) + "  "), key);
  }
  for (const char* text : {"", "lumitexel-", "lumitexel", "42", "lumitexel-4x", "lumitexel--4", "A. Adams",
                           "lumitexel-99999999999999999999"}) {
    EXPECT_FALSE(frame_key_of(text)) << text;
  }
}

}  // namespace
}  // namespace lumitexel
