#include "processing/calibration/calibration_options.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

TEST(CalibrationOptions, EveryStepHasANameOfItsOwnThatReadsBack) {
  std::set<std::string> names;
  for (const CalibrationStep step : all_calibration_steps()) {
    EXPECT_EQ(calibration_step_from_string(to_string(step)), step);
    names.insert(to_string(step));
  }
  EXPECT_EQ(names.size(), all_calibration_steps().size());
  EXPECT_BAD_INPUT(calibration_step_from_string("len"), "len", "lamp_drift");
}

// Results of different steps must never share a folder.
TEST(CalibrationOptions, TheKeyTellsWhatIsLeftOut) {
  std::set<std::string> keys{CalibrationOptions{}.key()};
  EXPECT_TRUE(keys.contains(""));
  for (const CalibrationStep step : all_calibration_steps()) {
    CalibrationOptions options;
    options.without.insert(step);
    EXPECT_FALSE(options.takes(step));
    EXPECT_TRUE(keys.insert(options.key()).second);
  }
}

}  // namespace
}  // namespace lumitexel
