// Numbers for one light path, a function of the pixel, the replicate and the sample's index and of nothing else: any
// thread may draw them, in any order.
//
// Each pair of coordinates is the (0,2)-sequence of Sobol, its index shuffled and its digits scrambled anew for every
// pixel, replicate and pair (Owen's nested scrambling by hashes: Burley 2020, "Practical hash-based Owen scrambling").
// Any first 2^k samples of a pixel are stratified in every pair; two replicates are independent, which is what tells
// the noise.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lumitexel {

class SampleSequence {
 public:
  SampleSequence(int x_px, int y_px, int replicate, std::uint32_t index);

  Eigen::Vector2d next();  // both in [0, 1)

 private:
  std::uint32_t key_, index_, pair_ = 0;
};

}  // namespace lumitexel
