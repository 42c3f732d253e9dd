// The loops of four neighbours, around which no height may be gained: their sides, and which lumitexel is in which.
#pragma once

#include <vector>

#include "processing/brdf/ordered_sum.h"
#include "processing/normals/normal_problem.h"

namespace lumitexel {

// Which loops a lumitexel is in, and as which corner: 4 * loop + corner.
struct LoopsOf {
  std::vector<std::size_t> corner, first{0};
};

struct Loops {
  std::vector<LoopSides> sides;  // of every loop: the factors of its four deviations, already over the mean side
  LoopsOf of;
  explicit Loops(const NormalProblem& problem);
};

// Height gained around each loop for given deviations.
template <typename DeviationOf>
std::vector<double> curls(const NormalProblem& problem, const Loops& loops, const DeviationOf& deviation_of) {
  std::vector<double> result(loops.sides.size());
  for_each_block(result.size(), [&](std::size_t l) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) sum += loops.sides[l][k].dot(deviation_of(problem.neighbours.loop[l][k]));
    result[l] = sum;
  });
  return result;
}

// Sum over a lumitexel's loops of side times curl.
Eigen::Vector3d pull_of_loops(const Loops& loops, const std::vector<double>& curl, std::size_t i);

}  // namespace lumitexel
