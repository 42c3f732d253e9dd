#include "processing/normals/smooth_normals.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "processing/brdf/ordered_sum.h"
#include "processing/normals/normal_system.h"

namespace lumitexel {
namespace {

constexpr double kLeastFacing = 0.02;  // cosine between normal and view: flatter, and fifty texels share a pixel
constexpr int kMostHalvings = 6;

constexpr double kFirstDamping = 1e-3, kMostDamping = 1e6, kDampingFactor = 10.0;
constexpr double kPoor = 0.75, kGood = 0.25;   // of what the quadratic promised, by how much a lumitexel's own terms may fall short of it
constexpr double kSettled = 1e-3;              // of E a step and lumitexel with samples: normals are then within some thirtieth of a sigma
constexpr int kMostTries = 4;                  // of one step, more damped each time

using Buffers = oneapi::tbb::enumerable_thread_specific<std::vector<DirectedSample>>;

// The parts of E: each lumitexel's own, which are its samples' and the coarse mesh's, and what lumitexels share.
struct Costs {
  std::vector<double> own;
  double shared = 0;
  double sum() const {
    return shared + ordered_sum(own.size(), 0.0, [&](std::size_t i, double& total) { total += own[i]; });
  }
};

Eigen::Vector3d deviation_of(const NormalProblem& problem, const NormalField& field, std::size_t i) {
  return field.normal[i] - problem.lumitexels.coarse_normal(i);
}

double shared_cost(const NormalProblem& problem, const Loops& loops, const NormalField& field, const NormalPrior& prior) {
  const double link = 1.0 / (prior.neighbour_sigma_rad * prior.neighbour_sigma_rad), curl_weight = 1.0 / (prior.curl_sigma_rad * prior.curl_sigma_rad);
  const std::vector<double> curl = curls(problem, loops, [&](std::size_t i) { return deviation_of(problem, field, i); });
  const double of_loops = ordered_sum(curl.size(), 0.0, [&](std::size_t l, double& sum) { sum += curl[l] * curl[l]; });
  return curl_weight * of_loops + ordered_sum(field.normal.size(), 0.0, [&](std::size_t i, double& sum) {
    const Eigen::Vector3d deviation = deviation_of(problem, field, i);
    for (std::size_t k = problem.neighbours.first[i]; k < problem.neighbours.first[i + 1]; ++k) {
      const std::size_t j = problem.neighbours.other[k];
      if (j > i) sum += edge_cost(link * (deviation_of(problem, field, j) - deviation).squaredNorm());
    }
  });
}

Costs costs(const NormalProblem& problem, const Loops& loops, const NormalField& field, const NormalField& scaled_by, const NormalPrior& prior) {
  const double coarse = 1.0 / (prior.coarse_sigma_rad * prior.coarse_sigma_rad);
  Costs result{std::vector<double>(field.normal.size()), shared_cost(problem, loops, field, prior)};
  Buffers buffers;
  oneapi::tbb::parallel_for(std::size_t{0}, field.normal.size(), [&](std::size_t i) {
    std::vector<DirectedSample>& samples = buffers.local();
    problem.lumitexels.samples_of(i, samples);
    result.own[i] = normal_cost(problem.material_of(i), {field.normal[i], field.weights[i].weight}, {scaled_by.normal[i], scaled_by.weights[i].weight},
                                samples, problem.lumitexels.channels()) +
                    coarse * deviation_of(problem, field, i).squaredNorm();
  });
  return result;
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

// The field after these steps, weights following.
NormalField moved_by(const NormalProblem& problem, const LinearSystem& system, const Steps& steps, double largest_rad, const NormalField& field) {
  NormalField reached = field;
  Buffers buffers;
  oneapi::tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t i) {
    std::vector<DirectedSample>& samples = buffers.local();
    problem.lumitexels.samples_of(i, samples);
    reached.normal[i] = stepped(field.normal[i], system.frame[i], steps[i], largest_rad, samples);
    reached.weights[i].weight =
        best_weights(problem.material_of(i), field.weights[i].weight, reached.normal[i], samples, problem.lumitexels.channels());
  });
  return reached;
}

// By how much the quadratic has a lumitexel's own terms fall on the way that its normal went.
double promised_gain(const LinearSystem& system, std::size_t i, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double coarse) {
  const Eigen::Vector2d step = system.frame[i].transpose() * (to - from);
  return 2.0 * system.right_alone[i].dot(step) - step.dot(system.data[i] * step) - coarse * step.squaredNorm();
}

// A lumitexel whose slopes said little of what came is damped more, one whose said all less.
void adapt(const LinearSystem& system, const NormalField& from, const NormalField& to, const Costs& before, const Costs& after, double coarse,
           std::vector<double>& damping) {
  for_each_block(damping.size(), [&](std::size_t i) {
    const double promised = promised_gain(system, i, from.normal[i], to.normal[i], coarse), gained = before.own[i] - after.own[i];
    const double short_of_it = promised - gained;
    if (!(short_of_it <= kPoor * std::abs(promised))) {
      damping[i] = std::min(kMostDamping, std::max(damping[i], kFirstDamping) * kDampingFactor);
    } else if (short_of_it <= kGood * std::abs(promised)) {
      damping[i] /= kDampingFactor;
    }
  });
}

std::size_t count_sampled(const NormalProblem& problem) {
  std::size_t sampled = 0;
  std::vector<DirectedSample> samples;
  for (std::size_t i = 0; i < problem.lumitexels.size(); ++i) {
    problem.lumitexels.samples_of(i, samples);
    sampled += samples.empty() ? 0 : 1;
  }
  return sampled;
}

// One step that lowers E, by how much; 0 where none was found.
double descend(const NormalProblem& problem, const Loops& loops, const SmoothNormalOptions& options, std::vector<double>& damping, NormalField& field) {
  const double coarse = 1.0 / (options.prior.coarse_sigma_rad * options.prior.coarse_sigma_rad);
  const LinearSystem system = linearise(problem, loops, field, options.prior);
  const Costs before = costs(problem, loops, field, field, options.prior);
  for (int tries = 0; tries < kMostTries; ++tries) {
    LinearSystem damped = system;
    damp(damping, damped);
    NormalField reached = moved_by(problem, system, solve(problem, loops, damped), options.largest_step_rad, field);
    const Costs after = costs(problem, loops, reached, field, options.prior);
    adapt(system, field, reached, before, after, coarse, damping);
    const double gain = before.sum() - after.sum();
    if (gain > 0.0) {
      field = std::move(reached);
      return gain;
    }
    for (double& share : damping) share = std::min(kMostDamping, std::max(share, kFirstDamping) * kDampingFactor);
  }
  return 0.0;
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

double normal_objective(const NormalProblem& problem, const NormalField& field, const NormalField& scaled_by, const NormalPrior& prior) {
  return costs(problem, Loops(problem), field, scaled_by, prior).sum();
}

NormalField smooth_normals(const NormalProblem& problem, NormalField field, const SmoothNormalOptions& options,
                           const std::function<void(int)>& after_step) {
  const Loops loops(problem);
  std::vector<double> damping(field.normal.size(), kFirstDamping);
  const double enough = kSettled * static_cast<double>(count_sampled(problem));
  for (int step = 0; step < options.most_steps; ++step) {
    const double gain = descend(problem, loops, options, damping, field);
    after_step(step + 1);
    if (gain <= enough) break;
  }
  return field;
}

}  // namespace lumitexel
