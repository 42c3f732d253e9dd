// A model's BRDFs made ready for light paths: how much each of their parts reflects, and directions drawn accordingly.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "processing/brdf/prepared_brdf.h"
#include "processing/model/model.h"
#include "processing/render/lobe_sampling.h"

namespace lumitexel {

// Diffuse light or the channels of one lobe that share a shape.
class ReflectingPart {
 public:
  // part: a BRDF of nothing but this part. Its reflected energy is tabulated over the angle, to about 1 %: from 256
  // directions of the part's own sampler at each of 33 cosines.
  ReflectingPart(const Brdf& part, const LobeSampler& sampler);

  const LobeSampler& sampler() const { return sampler_; }
  // Integral of f cos_i over all wi: the share of light that leaves for a viewer at cos_o, by reciprocity the share of
  // light from cos_o that is reflected. cos_o in (0, 1].
  ChannelValues albedo(double cos_o) const;

 private:
  static constexpr int kIntervals = 32;
  LobeSampler sampler_;
  std::array<ChannelValues, kIntervals + 1> albedo_{};
};

struct ReflectingBrdf {
  explicit ReflectingBrdf(const Brdf& brdf);
  PreparedBrdf brdf;
  std::vector<ReflectingPart> parts;
};

// The BRDFs that the texels of a stage mix.
class ReflectingModel {
 public:
  ReflectingModel(const Model& model, FitStage stage);  // keeps a reference to the model

  const Model& model() const { return model_; }
  const std::vector<ReflectingBrdf>& basis(int x, int y) const;  // of a texel with a material
  double weight(int x, int y, int k) const;

 private:
  const Model& model_;
  std::vector<std::vector<ReflectingBrdf>> basis_;  // per material; one for all at the single stage
  const Image* weights_ = nullptr;                  // none: one BRDF of weight 1
  bool single_ = false;
};

// One texel seen from one direction. Set anew for every point of a path, without allocating.
class TexelReflection {
 public:
  explicit TexelReflection(const ReflectingModel& model) : model_(model) {}

  // normal, wo: unit, in world. False where nothing is reflected towards wo: a black texel, or wo below the normal's
  // horizon.
  bool set(int x, int y, const Eigen::Vector3d& normal, const Eigen::Vector3d& wo);

  ChannelValues reflectance(const Eigen::Vector3d& wi) const;  // f cos_i, 1/sr
  Eigen::Vector3d sample(double choice, const Eigen::Vector2d& uniform) const;
  double density(const Eigen::Vector3d& wi) const;  // of sample(), 1/sr
  const ChannelValues& albedo() const { return albedo_; }

 private:
  struct Chosen {
    const LobeSampler* sampler;
    double share;
  };
  Eigen::Vector3d to_local(const Eigen::Vector3d& in_world) const { return local_from_world_ * in_world; }

  const ReflectingModel& model_;
  const std::vector<ReflectingBrdf>* basis_ = nullptr;
  int x_ = 0, y_ = 0;
  Eigen::Vector3d normal_, wo_;
  Eigen::Matrix3d local_from_world_;
  ChannelValues albedo_{};
  std::vector<Chosen> chosen_;
};

}  // namespace lumitexel
