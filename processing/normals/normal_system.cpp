#include "processing/normals/normal_system.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/LU>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kEdgeFreedom = 4.0;  // of Student's t over differences between neighbours
constexpr int kMostCgSteps = 60;
constexpr double kCgGain = 1e-3;      // of the residual: steps of a descent ask for no more

double edge_weight(double squares) { return (kEdgeFreedom + 2.0) / (kEdgeFreedom + squares); }

Steps times(const NormalProblem& problem, const Loops& loops, const LinearSystem& system, const Steps& x) {
  Steps result(x.size());
  const std::vector<double> curl = curls(problem, loops, [&](std::size_t i) { return (system.frame[i] * x[i]).eval(); });
  oneapi::tbb::parallel_for(std::size_t{0}, x.size(), [&](std::size_t i) {
    Eigen::Vector3d others = Eigen::Vector3d::Zero();
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      others += system.link[k] * (system.frame[j] * x[j]);
    }
    others -= system.curl_weight * pull_of_loops(loops, curl, i);
    result[i] = system.diagonal[i] * x[i] - system.frame[i].transpose() * others;
  });
  return result;
}

double dot(const Steps& a, const Steps& b) {
  return ordered_sum(a.size(), 0.0, [&](std::size_t i, double& sum) { sum += a[i].dot(b[i]); });
}

}  // namespace

double edge_cost(double squares) { return (kEdgeFreedom + 2.0) * std::log1p(squares / kEdgeFreedom); }

LinearSystem linearise(const NormalProblem& problem, const Loops& loops, const NormalField& field, const NormalPrior& prior) {
  const std::size_t n = problem.lumitexels.size();
  LinearSystem system{1.0 / (prior.curl_sigma_rad * prior.curl_sigma_rad),
                      std::vector<Eigen::Matrix2d>(n),
                      Steps(n),
                      std::vector<double>(problem.neighbours.other.size()),
                      std::vector<TangentFrame>(n),
                      std::vector<Eigen::Matrix2d>(n),
                      Steps(n),
                      std::vector<Eigen::Matrix2d>(n)};
  const std::vector<double> curl =
      curls(problem, loops, [&](std::size_t i) { return (field.normal[i] - problem.lumitexels.coarse_normal(i)).eval(); });
  const double coarse = 1.0 / (prior.coarse_sigma_rad * prior.coarse_sigma_rad);
  const double link = 1.0 / (prior.neighbour_sigma_rad * prior.neighbour_sigma_rad);
  oneapi::tbb::enumerable_thread_specific<std::vector<DirectedSample>> buffers;
  oneapi::tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
    std::vector<DirectedSample>& samples = buffers.local();
    problem.lumitexels.samples_of(i, samples);
    const TangentFrame frame = tangent_frame(field.normal[i]);
    const Eigen::Vector3d deviation = field.normal[i] - problem.lumitexels.coarse_normal(i);
    const NormalEquations equations =
        normal_equations(problem.material_of(i), field.weights[i].weight, field.normal[i], frame, samples, problem.lumitexels.channels());
    system.frame[i] = frame;
    system.diagonal[i] = system.data[i] = equations.matrix;
    Eigen::Vector3d pull = -coarse * deviation;
    double weight = coarse;
    system.right_alone[i] = equations.right + frame.transpose() * pull;
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      const Eigen::Vector3d difference = field.normal[j] - problem.lumitexels.coarse_normal(j) - deviation;
      system.link[k] = link * edge_weight(link * difference.squaredNorm());
      pull += system.link[k] * difference;
      weight += system.link[k];
    }
    system.diagonal[i] += weight * Eigen::Matrix2d::Identity();
    pull -= system.curl_weight * pull_of_loops(loops, curl, i);
    system.right[i] = equations.right + frame.transpose() * pull;
    system.own[i] = system.diagonal[i];
    for (std::size_t k = loops.of.first[i]; k < loops.of.first[i + 1]; ++k) {
      const Eigen::Vector2d side = frame.transpose() * loops.sides[loops.of.corner[k] / 4][loops.of.corner[k] % 4];
      system.own[i] += system.curl_weight * side * side.transpose();
    }
  });
  return system;
}

void damp(const std::vector<double>& share, LinearSystem& system) {
  for_each_block(share.size(), [&](std::size_t i) {
    const Eigen::Vector2d more = share[i] * system.own[i].diagonal();
    system.diagonal[i].diagonal() += more;
    system.own[i].diagonal() += more;
  });
}

Steps solve(const NormalProblem& problem, const Loops& loops, const LinearSystem& system) {
  const std::size_t n = system.right.size();
  std::vector<Eigen::Matrix2d> inverse(n);
  for_each_block(n, [&](std::size_t i) { inverse[i] = system.own[i].inverse(); });
  Steps x(n, Eigen::Vector2d::Zero()), residual = system.right, conditioned(n), direction(n);
  for_each_block(n, [&](std::size_t i) { direction[i] = conditioned[i] = inverse[i] * residual[i]; });
  double product = dot(residual, conditioned);
  const double enough = kCgGain * kCgGain * product;
  for (int step = 0; step < kMostCgSteps && product > enough; ++step) {
    const Steps moved = times(problem, loops, system, direction);
    const double length = product / dot(direction, moved);
    for_each_block(n, [&](std::size_t i) {
      x[i] += length * direction[i];
      residual[i] -= length * moved[i];
      conditioned[i] = inverse[i] * residual[i];
    });
    const double next = dot(residual, conditioned);
    const double turn = next / product;
    product = next;
    for_each_block(n, [&](std::size_t i) { direction[i] = conditioned[i] + turn * direction[i]; });
  }
  return x;
}

}  // namespace lumitexel
