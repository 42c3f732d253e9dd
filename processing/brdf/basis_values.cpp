#include "processing/brdf/basis_values.h"

#include "processing/brdf/evaluate_packed.h"
#include "processing/brdf/packed_geometries.h"

namespace lumitexel {
namespace {

bool same(const Brdf& a, const Brdf& b) {
  if (a.family != b.family || a.channels != b.channels || a.diffuse != b.diffuse || a.lobes.size() != b.lobes.size()) return false;
  for (std::size_t l = 0; l < a.lobes.size(); ++l) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(a.channels); ++c) {
      if (!a.lobes[l][c].same_shape(b.lobes[l][c]) || a.lobes[l][c].log_strength != b.lobes[l][c].log_strength) return false;
    }
  }
  return true;
}

}  // namespace

const char* to_string(Precision precision) { return precision == Precision::Float ? "float" : "double"; }

BasisValues::BasisValues(std::vector<Brdf> basis, Brdf material, Precision precision)
    : basis_(std::move(basis)), material_(std::move(material)), prepared_material_(material_), moved_(!same(basis_[0], material_)),
      precision_(precision) {
  for (const Brdf& brdf : basis_) prepared_.emplace_back(brdf);
}

void BasisValues::predict(std::span<const Observation> samples, std::vector<ChannelValues>& values) const {
  values.resize(samples.size() * (bases() + 1));
  precision_ == Precision::Float ? predict_in_float(samples, values) : predict_in_double(samples, values);
}

void BasisValues::predict_in_double(std::span<const Observation> samples, std::vector<ChannelValues>& values) const {
  for (std::size_t s = 0; s < samples.size(); ++s) {
    ChannelValues* const own = &values[s * (bases() + 1)];
    for (std::size_t k = 0; k < bases(); ++k) own[k] = predicted_reflectance(prepared_[k], samples[s].geometry);
    own[bases()] = moved_ ? predicted_reflectance(prepared_material_, samples[s].geometry) : own[0];
  }
}

void BasisValues::predict_in_float(std::span<const Observation> samples, std::vector<ChannelValues>& values) const {
  PackedGeometries geometries;
  geometries.reserve(samples.size());
  for (const Observation& sample : samples) geometries.add(sample.geometry);
  const auto channels = static_cast<std::size_t>(material_.channels);
  std::vector<float> packed(samples.size() * channels);
  const auto put = [&](const Brdf& brdf, std::size_t k) {
    evaluate(brdf, geometries, packed);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      for (std::size_t c = 0; c < channels; ++c) {
        values[s * (bases() + 1) + k][c] = static_cast<double>(packed[c * samples.size() + s]) * samples[s].geometry.cos_i;
      }
    }
  };
  for (std::size_t k = 0; k < bases(); ++k) put(basis_[k], k);
  if (moved_) return put(material_, bases());
  for (std::size_t s = 0; s < samples.size(); ++s) values[s * (bases() + 1) + bases()] = values[s * (bases() + 1)];
}

}  // namespace lumitexel
