// What the bases of a material's texels predict at samples: prepared once, asked for every texel.
#pragma once

#include <span>
#include <vector>

#include "processing/brdf/observations.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {

// Float: the kernels of evaluate_packed.h, with the errors stated there.
enum class Precision { Double, Float };
const char* to_string(Precision precision);  // "double", "float"

class BasisValues {
 public:
  // basis[0] may be `material` itself. All of one number of channels.
  BasisValues(std::vector<Brdf> basis, Brdf material, Precision precision);

  std::size_t bases() const { return basis_.size(); }
  // r = f cos_i: values[s * (bases() + 1) + k] of basis k at sample s, and behind them the material's.
  void predict(std::span<const Observation> samples, std::vector<ChannelValues>& values) const;

 private:
  void predict_in_double(std::span<const Observation> samples, std::vector<ChannelValues>& values) const;
  void predict_in_float(std::span<const Observation> samples, std::vector<ChannelValues>& values) const;

  std::vector<Brdf> basis_;
  Brdf material_;
  std::vector<PreparedBrdf> prepared_;
  PreparedBrdf prepared_material_;
  bool moved_;  // basis[0] is no longer the material
  Precision precision_;
};

}  // namespace lumitexel
