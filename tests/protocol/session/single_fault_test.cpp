// Every single fault at operations spread over a short session, connecting included: the session ends complete and
// correct, or in a safe pause that names a device and from which it can be completed. The whole matrix:
// fault_campaign --matrix.
#include <gtest/gtest.h>

#include "tests/protocol/session/single_faults.h"

namespace lumitexel {
namespace {

constexpr double kNoHang_s = 40.0;  // some 3 s on a quiet machine
constexpr int kSideBySide = 16;     // they wait most of the time

void expect_no_objection(CameraKind camera, std::uint64_t step) {
  const std::vector<SingleFault> all = fault_matrix(camera, count_operations(camera), step);
  std::size_t happened = 0;
  for (const SingleFaultOutcome& outcome : suffer_all(all, kSideBySide)) {
    EXPECT_EQ(outcome.objection, "") << outcome.what.text();
    EXPECT_LT(outcome.seconds, kNoHang_s) << outcome.what.text();
    happened += outcome.happened ? 1 : 0;
  }
  // At the last operations some faults have no occasion any more.
  EXPECT_GE(4 * happened, 3 * all.size());
}

TEST(SingleFault, OfAGigeRigEndsInACompleteSessionOrASafePause) { expect_no_objection(CameraKind::Gige, 40); }

TEST(SingleFault, OfAStillRigEndsInACompleteSessionOrASafePause) {
  offer_only_the_ptp_driver();
  expect_no_objection(CameraKind::Still, 80);
}

}  // namespace
}  // namespace lumitexel
