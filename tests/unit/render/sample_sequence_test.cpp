#include "processing/render/sample_sequence.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace lumitexel {
namespace {

std::vector<Eigen::Vector2d> points(int x, int y, int replicate, int pair, std::uint32_t count) {
  std::vector<Eigen::Vector2d> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    SampleSequence numbers(x, y, replicate, i);
    Eigen::Vector2d point = numbers.next();
    for (int p = 0; p < pair; ++p) point = numbers.next();
    result.push_back(point);
  }
  return result;
}

// The property that defines a (0,2)-sequence: of its first 2^k points one lies in each box of 2^-a by 2^-(k-a), for
// every a.
TEST(SampleSequence, EveryPairOfEveryPixelIsStratifiedInAllBoxes) {
  for (const int pair : {0, 1, 5}) {
    for (const int bits : {3, 4, 7}) {
      const auto all = points(17, 4, 2, pair, 1u << bits);
      for (int a = 0; a <= bits; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (const Eigen::Vector2d& point : all) {
          ASSERT_GE(point.minCoeff(), 0.0);
          ASSERT_LT(point.maxCoeff(), 1.0);
          boxes.emplace(static_cast<int>(point.x() * (1 << a)), static_cast<int>(point.y() * (1 << (bits - a))));
        }
        EXPECT_EQ(boxes.size(), all.size()) << pair << " " << bits << " " << a;
      }
    }
  }
}

double correlation(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i].x() - 0.5) * (b[i].x() - 0.5) + (a[i].y() - 0.5) * (b[i].y() - 0.5);
  return sum * 6.0 / static_cast<double>(a.size());
}

TEST(SampleSequence, PairsReplicatesAndPixelsAreIndependent) {
  constexpr std::uint32_t kCount = 1 << 12;
  constexpr double kFourSigma = 4.0 / 64.0;  // of a correlation of 4096 numbers
  const auto base = points(3, 9, 0, 0, kCount);
  EXPECT_NEAR(correlation(base, base), 1.0, 1e-3);
  EXPECT_LT(std::abs(correlation(base, points(3, 9, 0, 1, kCount))), kFourSigma);
  EXPECT_LT(std::abs(correlation(base, points(3, 9, 1, 0, kCount))), kFourSigma);
  EXPECT_LT(std::abs(correlation(base, points(4, 9, 0, 0, kCount))), kFourSigma);
  EXPECT_LT(std::abs(correlation(base, points(9, 3, 0, 0, kCount))), kFourSigma);
}

}  // namespace
}  // namespace lumitexel
