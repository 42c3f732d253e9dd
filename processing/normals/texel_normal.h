// What the samples of one lumitexel say about its normal (section 9 of the paper): the misfit of a normal, and its linear equations with
// the weights of the basis eliminated, so that normal and weights are solved together.
//
// Normals move in their tangent plane, which has no pole. Two coordinates: along the columns of tangent_frame(normal).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/prepared_brdf.h"
#include "processing/brdf/project_weights.h"
#include "processing/brdf/texel_system.h"
#include "processing/normals/directed_samples.h"

namespace lumitexel {

using TangentFrame = Eigen::Matrix<double, 3, 2>;

// Two unit vectors across the unit normal and each other (Duff et al. 2017).
TangentFrame tangent_frame(const Eigen::Vector3d& normal);
// The unit normal after a step in its tangent plane.
inline Eigen::Vector3d moved(const Eigen::Vector3d& normal, const TangentFrame& frame, const Eigen::Vector2d& step) {
  return (normal + frame * step).normalized();
}

// A material made ready for many lumitexels of it.
struct NormalMaterial {
  std::vector<PreparedBrdf> basis;
  BasisMatrix prior;     // precision of the weights about (1, 0, 0, …); empty where they may not vary
  BasisVector prior_right;
  ErrorModel error;

  NormalMaterial(const std::vector<Brdf>& basis, int channels, const ErrorModel& error, const TexelPrior& prior);
};

// Reflectance r = f cos_i of the mixture at this normal; 0 where it faces away from light or viewer.
ChannelValues predicted_reflectance(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                    const DirectedSample& sample, int channels);

// What a texel is taken to be.
struct TexelState {
  const Eigen::Vector3d& normal;
  const std::vector<float>& weight;
};

// Minus twice the log likelihood of the samples and of the weights' prior, up to a constant; each sample's scale as `scaled_by` predicts it.
// normal_equations at `scaled_by` has the slopes of it.
double normal_cost(const NormalMaterial& material, const TexelState& texel, const TexelState& scaled_by, std::span<const DirectedSample> samples,
                   int channels);

// Quadratic form of the misfit over the tangent step d, weights following: d^T matrix d / 2 - right^T d.
struct NormalEquations {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
};
NormalEquations normal_equations(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                 const TangentFrame& frame, std::span<const DirectedSample> samples, int channels);

// Best weights for this normal, from samples that count as robustly as the given ones have it.
std::vector<float> best_weights(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                std::span<const DirectedSample> samples, int channels);

}  // namespace lumitexel
