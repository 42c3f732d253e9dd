#include "processing/normals/smooth_normals.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr double kEdgeFreedom = 4.0;     // of Student's t over differences between neighbours
constexpr double kLeastInformation = 1e-6;  // per square radian, so that a lumitexel without samples has a factor, too
constexpr int kMostCgSteps = 60;
constexpr double kLeastFacing = 0.02;  // cosine between normal and view: flatter, and fifty texels share a pixel
constexpr int kMostHalvings = 6;
constexpr double kCgGain = 1e-3;         // of the residual: Gauss-Newton asks for no more

using Steps = std::vector<Eigen::Vector2d>;

// Of every loop: the factors of its four deviations, already over the mean side.
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

// Which loops a lumitexel is in, and as which corner: 4 * loop + corner.
struct LoopsOf {
  std::vector<std::size_t> corner, first{0};
};

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

struct Loops {
  std::vector<LoopSides> sides;
  LoopsOf of;
  explicit Loops(const NormalProblem& problem) : sides(loop_sides(problem)), of(loops_of(problem)) {}
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
Eigen::Vector3d pull_of_loops(const Loops& loops, const std::vector<double>& curl, std::size_t i) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = loops.of.first[i]; k < loops.of.first[i + 1]; ++k) {
    const std::size_t corner = loops.of.corner[k];
    sum += curl[corner / 4] * loops.sides[corner / 4][corner % 4];
  }
  return sum;
}

struct LinearSystem {
  double curl_weight = 0;
  std::vector<Eigen::Matrix2d> diagonal;  // all of a lumitexel's own terms but its loops', which are in `own` alone
  Steps right;
  std::vector<double> link;          // weight of each neighbour relation, as Neighbours::other
  std::vector<TangentFrame> frame;
  std::vector<Eigen::Matrix2d> data;  // what the samples alone say
  std::vector<Eigen::Matrix2d> own;   // diagonal with the loops: for preconditioning
};

double edge_weight(double squares) { return (kEdgeFreedom + 2.0) / (kEdgeFreedom + squares); }
double edge_cost(double squares) { return (kEdgeFreedom + 2.0) * std::log1p(squares / kEdgeFreedom); }

using Buffers = oneapi::tbb::enumerable_thread_specific<std::vector<DirectedSample>>;

LinearSystem linearise(const NormalProblem& problem, const Loops& loops, const NormalField& field, const NormalPrior& prior) {
  const std::size_t n = problem.lumitexels.size();
  LinearSystem system{1.0 / (prior.curl_sigma_rad * prior.curl_sigma_rad),
                      std::vector<Eigen::Matrix2d>(n),
                      Steps(n),
                      std::vector<double>(problem.neighbours.other.size()),
                      std::vector<TangentFrame>(n),
                      std::vector<Eigen::Matrix2d>(n),
                      std::vector<Eigen::Matrix2d>(n)};
  const std::vector<double> curl =
      curls(problem, loops, [&](std::size_t i) { return (field.normal[i] - problem.lumitexels.coarse_normal(i)).eval(); });
  const double coarse = 1.0 / (prior.coarse_sigma_rad * prior.coarse_sigma_rad);
  const double link = 1.0 / (prior.neighbour_sigma_rad * prior.neighbour_sigma_rad);
  Buffers buffers;
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

// Conjugate gradients, preconditioned by each lumitexel's own block.
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

// The cosine between the normal and the view that sees it at the flattest; 1 without samples.
double least_facing(const Eigen::Vector3d& normal, std::span<const DirectedSample> samples) {
  double least = 1.0;
  for (const DirectedSample& sample : samples) least = std::min(least, normal.dot(sample.wo));
  return least;
}

// Facing away would explain any dark sample, so a normal stays in the hemisphere that its photographs can see: a step that leaves it is halved
// until it does not, or not taken.
Eigen::Vector3d stepped(const Eigen::Vector3d& normal, const TangentFrame& frame, const Eigen::Vector2d& step, double largest_rad,
                        std::span<const DirectedSample> samples) {
  const double length = step.norm();
  const double allowed = std::min(kLeastFacing, least_facing(normal, samples));  // a mean of normals may start below
  double share = length > largest_rad ? largest_rad / length : 1.0;
  for (int halving = 0; halving <= kMostHalvings; ++halving, share *= 0.5) {
    const Eigen::Vector3d reached = moved(normal, frame, share * step);
    if (least_facing(reached, samples) >= allowed) return reached;
  }
  return normal;
}

// Takes the steps; weights follow.
void take(const NormalProblem& problem, const LinearSystem& system, const Steps& steps, double largest_rad, NormalField& field) {
  Buffers buffers;
  oneapi::tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t i) {
    std::vector<DirectedSample>& samples = buffers.local();
    problem.lumitexels.samples_of(i, samples);
    field.normal[i] = stepped(field.normal[i], system.frame[i], steps[i], largest_rad, samples);
    field.weights[i].weight =
        best_weights(problem.material_of(i), field.weights[i].weight, field.normal[i], samples, problem.lumitexels.channels());
  });
}

using Draw = std::function<double()>;

// Random numbers with the samples' information as covariance.
Steps samples_right(const LinearSystem& system, const Draw& draw) {
  Steps right;
  for (const Eigen::Matrix2d& data : system.data) {
    const Eigen::LLT<Eigen::Matrix2d> factor(data + kLeastInformation * Eigen::Matrix2d::Identity());
    right.push_back(factor.matrixL() * Eigen::Vector2d(draw(), draw()));
  }
  return right;
}

// Random numbers with the prior's information as covariance.
Steps prior_right(const NormalProblem& problem, const Loops& loops, const LinearSystem& system, const NormalPrior& prior, const Draw& draw) {
  const std::size_t n = problem.lumitexels.size();
  const double coarse = 1.0 / prior.coarse_sigma_rad;
  std::vector<Eigen::Vector3d> pull(n, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    pull[i] += coarse * Eigen::Vector3d(draw(), draw(), draw());  // in world: the same draw whatever the frame
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      if (j < i) continue;
      const Eigen::Vector3d both = std::sqrt(system.link[k]) * Eigen::Vector3d(draw(), draw(), draw());
      pull[i] += both;
      pull[j] -= both;
    }
  }
  for (std::size_t l = 0; l < loops.sides.size(); ++l) {
    const double value = draw() * std::sqrt(system.curl_weight);
    for (std::size_t k = 0; k < 4; ++k) pull[problem.neighbours.loop[l][k]] += value * loops.sides[l][k];
  }
  Steps right(n);
  for (std::size_t i = 0; i < n; ++i) right[i] = system.frame[i].transpose() * pull[i];
  return right;
}

// Rms over draws and axes of what the system solves right sides to; each solution is shown to `see`.
template <typename RightSide, typename See>
std::vector<float> drawn_sigmas(const NormalProblem& problem, const Loops& loops, LinearSystem& system, std::uint64_t first_seed,
                                RightSide right_side, See see) {
  std::vector<double> squares(problem.lumitexels.size(), 0.0);
  for (std::uint64_t k = 0; k < kSigmaDraws; ++k) {
    std::mt19937_64 random(first_seed + k);
    std::normal_distribution<double> normal;
    system.right = right_side([&] { return normal(random); });
    const Steps steps = solve(problem, loops, system);
    for (std::size_t i = 0; i < steps.size(); ++i) squares[i] += steps[i].squaredNorm() / (2.0 * kSigmaDraws);
    see(steps);
  }
  std::vector<float> sigmas(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i) sigmas[i] = static_cast<float>(std::sqrt(squares[i]));
  return sigmas;
}

PriorDraw in_world(const LinearSystem& system, const Steps& steps) {
  PriorDraw draw;
  for (std::size_t i = 0; i < steps.size(); ++i) draw.push_back(system.frame[i] * steps[i]);
  return draw;
}

}  // namespace

NormalField field_on_mesh(const NormalProblem& problem) {
  NormalField field{std::vector<Eigen::Vector3d>(problem.lumitexels.size()), std::vector<TexelWeights>(problem.lumitexels.size())};
  for (std::size_t i = 0; i < field.normal.size(); ++i) {
    field.normal[i] = problem.lumitexels.coarse_normal(i);
    field.weights[i].weight.assign(problem.material_of(i).basis.size(), 0.0f);
    field.weights[i].weight[0] = 1.0f;
  }
  return field;
}

NormalSigmas normal_sigmas(const NormalProblem& problem, const NormalField& field, const NormalPrior& prior, std::vector<PriorDraw>* draws) {
  const Loops loops(problem);
  LinearSystem system = linearise(problem, loops, field, prior);
  const auto of_samples = [&](const Draw& draw) { return samples_right(system, draw); };
  const auto of_prior = [&](const Draw& draw) { return prior_right(problem, loops, system, prior, draw); };
  NormalSigmas sigmas;
  sigmas.samples_rad = drawn_sigmas(problem, loops, system, 0, of_samples, [](const Steps&) {});
  sigmas.prior_rad = drawn_sigmas(problem, loops, system, kSigmaDraws, of_prior, [&](const Steps& steps) {
    if (draws != nullptr) draws->push_back(in_world(system, steps));
  });
  return sigmas;
}

double normal_objective(const NormalProblem& problem, const NormalField& field, const NormalPrior& prior) {
  const double coarse = 1.0 / (prior.coarse_sigma_rad * prior.coarse_sigma_rad);
  const double link = 1.0 / (prior.neighbour_sigma_rad * prior.neighbour_sigma_rad);
  const Loops loops(problem);
  const std::vector<double> curl =
      curls(problem, loops, [&](std::size_t i) { return (field.normal[i] - problem.lumitexels.coarse_normal(i)).eval(); });
  const double loop_cost =
      ordered_sum(curl.size(), 0.0, [&](std::size_t l, double& sum) { sum += curl[l] * curl[l]; }) / (prior.curl_sigma_rad * prior.curl_sigma_rad);
  Buffers buffers;
  return loop_cost + ordered_sum(field.normal.size(), 0.0, [&](std::size_t i, double& sum) {
    std::vector<DirectedSample>& samples = buffers.local();
    problem.lumitexels.samples_of(i, samples);
    const Eigen::Vector3d deviation = field.normal[i] - problem.lumitexels.coarse_normal(i);
    sum += normal_misfit(problem.material_of(i), field.weights[i].weight, field.normal[i], samples, problem.lumitexels.channels());
    sum += coarse * deviation.squaredNorm();
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      if (j < i) continue;
      sum += edge_cost(link * (field.normal[j] - problem.lumitexels.coarse_normal(j) - deviation).squaredNorm());
    }
  });
}

NormalField smooth_normals(const NormalProblem& problem, NormalField field, const SmoothNormalOptions& options,
                           const std::function<void(int)>& after_step) {
  const Loops loops(problem);
  for (int step = 0; step < options.steps; ++step) {
    const LinearSystem system = linearise(problem, loops, field, options.prior);
    take(problem, system, solve(problem, loops, system), options.largest_step_rad, field);
    after_step(step + 1);
  }
  return field;
}

}  // namespace lumitexel
