#include "processing/normals/texel_normal.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kStep_rad = 1e-6;  // of the difference quotient: a lobe of exponent 1e5 is 3e-3 wide, rounding stays at 1e-10 of it

constexpr int kMostUnknowns = 2 + kMaxBasis;
using Slopes = Eigen::Matrix<double, kMaxChannels, kMostUnknowns>;  // d r / d (step, weights), whitened
using Matrix = Eigen::Matrix<double, kMostUnknowns, kMostUnknowns>;
using Vector = Eigen::Matrix<double, kMostUnknowns, 1>;

// r of every basis function: columns.
using BasisValues = Eigen::Matrix<double, kMaxChannels, kMaxBasis>;

BasisValues basis_values(const NormalMaterial& material, unsigned wanted, const Eigen::Vector3d& normal, const DirectedSample& sample,
                         int channels) {
  BasisValues values = BasisValues::Zero();
  const LobeGeometry geometry = lobe_geometry(normal, sample.wi, sample.wo);
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return values;
  for (std::size_t k = 0; k < material.basis.size(); ++k) {
    if (!(wanted >> k & 1u)) continue;
    const ChannelValues value = predicted_reflectance(material.basis[k], geometry);
    for (int c = 0; c < channels; ++c) values(c, static_cast<Eigen::Index>(k)) = value[static_cast<std::size_t>(c)];
  }
  return values;
}

unsigned used(const std::vector<float>& weight) {
  unsigned mask = 0;
  for (std::size_t k = 0; k < weight.size(); ++k) mask |= weight[k] > 0.0f ? 1u << k : 0u;
  return mask;
}

ChannelValues mixed(const BasisValues& values, const std::vector<float>& weight) {
  ChannelValues sum{};
  for (std::size_t k = 0; k < weight.size(); ++k) {
    for (std::size_t c = 0; c < sum.size(); ++c) {
      sum[c] += static_cast<double>(weight[k]) * values(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k));
    }
  }
  return sum;
}

// Scales each row by its error's scale, and turns rows so that channels err independently.
template <typename Rows>
void whiten(const ErrorModel& error, const ScaledResiduals& residuals, double count, int channels, Rows& rows) {
  for (int c = 0; c < channels; ++c) rows.row(c) *= std::sqrt(count) / residuals.scale[static_cast<std::size_t>(c)];
  if (error.whitening().size() == 0) return;
  for (int c = channels - 1; c >= 0; --c) {  // lower triangular: from the last, so that what is read is still unturned
    rows.row(c) *= error.whitening()(c, c);
    for (int j = 0; j < c; ++j) rows.row(c) += error.whitening()(c, j) * rows.row(j);
  }
}

// Adds one sample's equations for (step, weights).
void add_sample(const NormalMaterial& material, const std::vector<float>& weight, unsigned wanted, const Eigen::Vector3d& normal,
                const TangentFrame* frame, const DirectedSample& sample, int channels, Matrix& matrix, Vector& right) {
  const BasisValues values = basis_values(material, wanted, normal, sample, channels);
  const ChannelValues predicted = mixed(values, weight);
  const ScaledResiduals residuals = scaled_residuals(material.error, sample.observation, channels, predicted);
  const double count = robust_weight(material.error, sample_misfit(material.error, residuals, channels), channels);
  Eigen::Matrix<double, kMaxChannels, kMostUnknowns + 1> rows = Eigen::Matrix<double, kMaxChannels, kMostUnknowns + 1>::Zero();
  if (frame != nullptr) {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d beside = moved(normal, *frame, axis == 0 ? Eigen::Vector2d(kStep_rad, 0.0) : Eigen::Vector2d(0.0, kStep_rad));
      const ChannelValues there = mixed(basis_values(material, used(weight), beside, sample, channels), weight);
      for (int c = 0; c < channels; ++c) {
        rows(c, axis) = (there[static_cast<std::size_t>(c)] - predicted[static_cast<std::size_t>(c)]) / kStep_rad;
      }
    }
  }
  rows.block<kMaxChannels, kMaxBasis>(0, 2) = values;
  for (int c = 0; c < channels; ++c) rows(c, kMostUnknowns) = static_cast<double>(sample.observation.reflectance[static_cast<std::size_t>(c)]);
  whiten(material.error, residuals, count, channels, rows);
  const Slopes slopes = rows.leftCols<kMostUnknowns>();
  matrix.noalias() += slopes.transpose() * slopes;
  right.noalias() += slopes.transpose() * rows.col(kMostUnknowns);
}

// Of the weights, up to a constant.
double prior_cost(const NormalMaterial& material, const std::vector<float>& weight) {
  if (material.prior.size() == 0) return 0.0;
  const BasisVector w = Eigen::Map<const Eigen::VectorXf>(weight.data(), static_cast<Eigen::Index>(weight.size())).cast<double>();
  return w.dot(material.prior * w) - 2.0 * w.dot(material.prior_right);
}

}  // namespace

TangentFrame tangent_frame(const Eigen::Vector3d& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z()), b = n.x() * n.y() * a;
  TangentFrame frame;
  frame.col(0) = Eigen::Vector3d(1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  frame.col(1) = Eigen::Vector3d(b, sign + n.y() * n.y() * a, -n.y());
  return frame;
}

NormalMaterial::NormalMaterial(const std::vector<Brdf>& brdfs, int channels, const ErrorModel& model, const TexelPrior& widths)
    : error(model) {
  for (const Brdf& brdf : brdfs) basis.emplace_back(brdf);
  if (nothing_varies(widths)) return;
  const auto n = static_cast<Eigen::Index>(brdfs.size());
  prior = BasisMatrix::Zero(n, n);
  prior_right = BasisVector::Zero(n);
  PriorPrecision(brdfs, channels).add_to(widths, prior, prior_right);
}

ChannelValues predicted_reflectance(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                    const DirectedSample& sample, int channels) {
  return mixed(basis_values(material, used(weight), normal, sample, channels), weight);
}

double normal_cost(const NormalMaterial& material, const TexelState& texel, const TexelState& scaled_by, std::span<const DirectedSample> samples,
                   int channels) {
  DevianceSum sum(material.error, channels);
  for (const DirectedSample& sample : samples) {
    const ChannelValues predicted = predicted_reflectance(material, texel.weight, texel.normal, sample, channels);
    const ChannelValues scaling = predicted_reflectance(material, scaled_by.weight, scaled_by.normal, sample, channels);
    ScaledResiduals residuals = scaled_residuals(material.error, sample.observation, channels, scaling);
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) residuals.over_scale[c] += (scaling[c] - predicted[c]) / residuals.scale[c];
    sum.add(sample_misfit(material.error, residuals, channels));
  }
  return sum.total() + prior_cost(material, texel.weight);
}

NormalEquations normal_equations(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                 const TangentFrame& frame, std::span<const DirectedSample> samples, int channels) {
  Matrix all = Matrix::Zero();
  Vector right = Vector::Zero();
  const unsigned mask = used(weight);
  for (const DirectedSample& sample : samples) {
    add_sample(material, weight, mask, normal, &frame, sample, channels, all, right);
  }
  NormalEquations result{all.topLeftCorner<2, 2>(), right.head<2>()};
  // The weights that are not held at zero, and their prior.
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (mask >> k & 1u) free.push_back(static_cast<Eigen::Index>(k));
  }
  const auto n = static_cast<Eigen::Index>(free.size());
  BasisMatrix own(n, n);
  BasisVector own_right(n);
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, kMaxBasis> across(2, n);
  const bool varies = material.prior.size() > 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    own_right[i] = right[2 + free[static_cast<std::size_t>(i)]];
    across.col(i) = all.block<2, 1>(0, 2 + free[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < n; ++j) own(i, j) = all(2 + free[static_cast<std::size_t>(i)], 2 + free[static_cast<std::size_t>(j)]);
  }
  BasisVector fixed(n);
  for (Eigen::Index i = 0; i < n; ++i) fixed[i] = static_cast<double>(weight[static_cast<std::size_t>(free[static_cast<std::size_t>(i)])]);
  if (!varies) {
    result.right -= across * fixed;
    return result;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    own_right[i] += material.prior_right[free[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j) own(i, j) += material.prior(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::LDLT<BasisMatrix> factor(own);
  result.matrix -= across * factor.solve(across.transpose());
  result.right -= across * factor.solve(own_right);
  return result;
}

std::vector<float> best_weights(const NormalMaterial& material, const std::vector<float>& weight, const Eigen::Vector3d& normal,
                                std::span<const DirectedSample> samples, int channels) {
  if (material.prior.size() == 0 || samples.empty()) return weight;
  Matrix all = Matrix::Zero();
  Vector right = Vector::Zero();
  const unsigned every = (1u << material.basis.size()) - 1u;
  for (const DirectedSample& sample : samples) add_sample(material, weight, every, normal, nullptr, sample, channels, all, right);
  const auto n = static_cast<Eigen::Index>(material.basis.size());
  const NnlsSolution solution =
      solve_nnls(all.block(2, 2, n, n) + material.prior, right.segment(2, n) + material.prior_right);
  if (!solution.weights.allFinite()) return weight;
  std::vector<float> result(weight.size());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = static_cast<float>(solution.weights[static_cast<Eigen::Index>(k)]);
  return result;
}

}  // namespace lumitexel
