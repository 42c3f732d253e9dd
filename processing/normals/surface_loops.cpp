#include "processing/normals/surface_loops.h"

#include <array>

namespace lumitexel {
namespace {

std::vector<LoopSides> loop_sides(const NormalProblem& problem) {
  std::vector<LoopSides> sides(problem.neighbours.loop.size());
  for_each_block(sides.size(), [&](std::size_t l) {
    std::array<Eigen::Vector3d, 4> edge;
    double length = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      edge[k] = problem.lumitexels.position(problem.neighbours.loop[l][(k + 1) % 4]) - problem.lumitexels.position(problem.neighbours.loop[l][k]);
      length += 0.25 * edge[k].norm();
    }
    for (std::size_t k = 0; k < 4; ++k) sides[l][k] = 0.5 * (edge[k] + edge[(k + 3) % 4]) / length;
  });
  return sides;
}

LoopsOf loops_of(const NormalProblem& problem) {
  std::vector<std::size_t> count(problem.lumitexels.size() + 1, 0);
  for (const auto& loop : problem.neighbours.loop) {
    for (const std::uint32_t i : loop) ++count[i + 1];
  }
  LoopsOf result;
  result.first.assign(count.size(), 0);
  for (std::size_t i = 1; i < count.size(); ++i) result.first[i] = result.first[i - 1] + count[i];
  result.corner.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (std::size_t l = 0; l < problem.neighbours.loop.size(); ++l) {
    for (std::size_t k = 0; k < 4; ++k) result.corner[next[problem.neighbours.loop[l][k]]++] = 4 * l + k;
  }
  return result;
}

}  // namespace

Loops::Loops(const NormalProblem& problem) : sides(loop_sides(problem)), of(loops_of(problem)) {}

Eigen::Vector3d pull_of_loops(const Loops& loops, const std::vector<double>& curl, std::size_t i) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = loops.of.first[i]; k < loops.of.first[i + 1]; ++k) {
    const std::size_t corner = loops.of.corner[k];
    sum += curl[corner / 4] * loops.sides[corner / 4][corner % 4];
  }
  return sum;
}

}  // namespace lumitexel
