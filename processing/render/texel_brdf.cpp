#include "processing/render/texel_brdf.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr int kDirections = 256;
constexpr double kGrazingCosine = 1e-3;  // stands for the table's end at 0
// Of all directions this share is drawn by the cosine, whatever the parts reflect: no direction that reflects is never
// drawn.
constexpr double kCosineShare = 0.05;
const LobeSampler kCosine;

bool is_off(const Lobe& lobe) { return lobe.log_strength == -std::numeric_limits<double>::infinity(); }

Eigen::Vector2d hammersley(int index, int count) {
  double reversed = 0.0, digit = 0.5;
  for (int bits = index; bits > 0; bits >>= 1, digit *= 0.5) reversed += digit * (bits & 1);
  return {(index + 0.5) / count, reversed + 0.5 / count};
}

ChannelValues reflected_energy(const PreparedBrdf& brdf, const LobeSampler& sampler, double cos_o) {
  const Eigen::Vector3d wo(std::sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);
  ChannelValues sum{};
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3d wi = sampler.sample(wo, hammersley(i, kDirections));
    const double density = sampler.density(wo, wi);
    if (!(wi.z() > 0.0) || !(density > 0.0)) continue;
    const ChannelValues r = predicted_reflectance(brdf, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo));
    for (std::size_t c = 0; c < r.size(); ++c) sum[c] += r[c] / density / kDirections;
  }
  return sum;
}

Brdf empty_like(const Brdf& brdf) {
  Brdf part;
  part.family = brdf.family;
  part.channels = brdf.channels;
  return part;
}

// The channels from `first` on that share its shape, and no others; marks them as done.
Brdf lobe_part(const Brdf& brdf, const std::array<Lobe, kMaxChannels>& lobe, std::size_t first,
               std::array<bool, kMaxChannels>& done) {
  Brdf part = empty_like(brdf);
  std::array<Lobe, kMaxChannels> alone;
  for (std::size_t c = 0; c < static_cast<std::size_t>(brdf.channels); ++c) {
    alone[c] = lobe[first];
    alone[c].log_strength = -std::numeric_limits<double>::infinity();
    if (done[c] || is_off(lobe[c]) || !lobe[c].same_shape(lobe[first])) continue;
    alone[c] = lobe[c];
    done[c] = true;
  }
  part.lobes = {alone};
  return part;
}

double mean(const ChannelValues& values, int channels) {
  double sum = 0.0;
  for (int c = 0; c < channels; ++c) sum += values[static_cast<std::size_t>(c)];
  return sum / channels;
}

Eigen::Matrix3d frame_about(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d beside = std::abs(normal.x()) < 0.5 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d right = beside.cross(normal).normalized();
  Eigen::Matrix3d frame;
  frame << right.transpose(), normal.cross(right).transpose(), normal.transpose();
  return frame;
}

}  // namespace

ReflectingPart::ReflectingPart(const Brdf& part, const LobeSampler& sampler) : sampler_(sampler) {
  const PreparedBrdf prepared(part);
  for (int i = 0; i <= kIntervals; ++i) {
    const double cos_o = i == 0 ? kGrazingCosine : static_cast<double>(i) / kIntervals;
    albedo_[static_cast<std::size_t>(i)] = reflected_energy(prepared, sampler_, cos_o);
  }
}

ChannelValues ReflectingPart::albedo(double cos_o) const {
  const double at = std::clamp(cos_o, 0.0, 1.0) * kIntervals;
  const auto low = static_cast<std::size_t>(std::min(static_cast<int>(at), kIntervals - 1));
  const double share = at - static_cast<double>(low);
  ChannelValues values{};
  for (std::size_t c = 0; c < values.size(); ++c)
    values[c] = (1.0 - share) * albedo_[low][c] + share * albedo_[low + 1][c];
  return values;
}

ReflectingBrdf::ReflectingBrdf(const Brdf& whole) : brdf(whole) {
  if (std::any_of(whole.diffuse.begin(), whole.diffuse.end(), [](double kd) { return kd > 0.0; })) {
    Brdf diffuse = empty_like(whole);
    diffuse.diffuse = whole.diffuse;
    parts.emplace_back(diffuse, kCosine);
  }
  for (const auto& lobe : whole.lobes) {
    std::array<bool, kMaxChannels> done{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(whole.channels); ++c) {
      if (done[c] || is_off(lobe[c])) continue;
      parts.emplace_back(lobe_part(whole, lobe, c, done), LobeSampler(whole.family, lobe[c].log_shape, lobe[c].aim));
    }
  }
}

ReflectingModel::ReflectingModel(const Model& model, FitStage stage)
    : model_(model), single_(stage == FitStage::Single) {
  const auto prepared = [](const std::vector<Brdf>& basis) {
    return std::vector<ReflectingBrdf>(basis.begin(), basis.end());
  };
  if (single_) {
    basis_.push_back(prepared({model.single}));
    return;
  }
  const bool before = stage == FitStage::Projection && has_principal_functions(model);
  if (stage != FitStage::Cluster) weights_ = before ? &model.projection_weights : &model.weights;
  for (const ModelMaterial& material : model.materials) {
    basis_.push_back(prepared(stage == FitStage::Cluster ? std::vector<Brdf>{material.brdf}
                              : before                   ? material.projection_basis
                                                         : material.basis));
  }
}

const std::vector<ReflectingBrdf>& ReflectingModel::basis(int x, int y) const {
  if (single_) return basis_.front();
  const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(model_.width) + static_cast<std::size_t>(x);
  return basis_[static_cast<std::size_t>(model_.material[texel])];
}

double ReflectingModel::weight(int x, int y, int k) const { return weights_ == nullptr ? 1.0 : weights_->at(x, y, k); }

bool TexelReflection::set(int x, int y, const Eigen::Vector3d& normal, const Eigen::Vector3d& wo) {
  x_ = x;
  y_ = y;
  normal_ = normal;
  wo_ = wo;
  basis_ = &model_.basis(x, y);
  albedo_ = {};
  chosen_.clear();
  const double cos_o = normal.dot(wo);
  if (!(cos_o > 0.0)) return false;
  local_from_world_ = frame_about(normal);
  double total = 0.0;
  for (std::size_t k = 0; k < basis_->size(); ++k) {
    const double weight = model_.weight(x, y, static_cast<int>(k));
    if (!(weight > 0.0)) continue;
    for (const ReflectingPart& part : (*basis_)[k].parts) {
      const ChannelValues energy = part.albedo(cos_o);
      for (std::size_t c = 0; c < energy.size(); ++c) albedo_[c] += weight * energy[c];
      chosen_.push_back({&part.sampler(), weight * mean(energy, model_.model().channels)});
      total += chosen_.back().share;
    }
  }
  if (!(total > 0.0)) return false;
  for (Chosen& chosen : chosen_) chosen.share *= (1.0 - kCosineShare) / total;
  chosen_.push_back({&kCosine, kCosineShare});
  return true;
}

ChannelValues TexelReflection::reflectance(const Eigen::Vector3d& wi) const {
  ChannelValues sum{};
  const LobeGeometry geometry = lobe_geometry(normal_, wi, wo_);
  if (!(geometry.cos_i > 0.0)) return sum;
  for (std::size_t k = 0; k < basis_->size(); ++k) {
    const double weight = model_.weight(x_, y_, static_cast<int>(k));
    if (!(weight > 0.0)) continue;
    const ChannelValues f = (*basis_)[k].brdf.value(geometry);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += weight * geometry.cos_i * f[c];
  }
  return sum;
}

Eigen::Vector3d TexelReflection::sample(double choice, const Eigen::Vector2d& uniform) const {
  std::size_t part = 0;
  for (; part + 1 < chosen_.size() && choice >= chosen_[part].share; ++part) choice -= chosen_[part].share;
  return local_from_world_.transpose() * chosen_[part].sampler->sample(to_local(wo_), uniform);
}

double TexelReflection::density(const Eigen::Vector3d& wi) const {
  const Eigen::Vector3d wo_local = to_local(wo_), wi_local = to_local(wi);
  double density = 0.0;
  for (const Chosen& chosen : chosen_) {
    if (chosen.share > 0.0) density += chosen.share * chosen.sampler->density(wo_local, wi_local);
  }
  return density;
}

}  // namespace lumitexel
