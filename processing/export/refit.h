// A mixture of BRDFs brought to glTF's material, or Mitsuba's (material_form.h), by sampling it, not by renaming its parameters.
//
// Over a fixed set of directions (half vectors spaced by the logarithm of their tilt, so that sharp and broad lobes are both resolved) the
// material is fitted by least squares of f cos_i, weighted by solid angle and by how much of a sphere's picture is seen at that angle. The
// viewer's angles end where the two kinds of highlight part: a microfacet lobe grows towards grazing as a Lafortune lobe does not, and
// whoever fits there loses the highlight everywhere else.
//
// For a given roughness the material is linear in base (1 - max f0) and f0; the best roughness is searched among kRoughnesses values, each
// with highlights that stay as they are at grazing angles (specular = max f0, none at all for a matte surface) and with highlights that
// rise to 1 there (specular = 1; not in Mitsuba's). Where channels' f0 differ and do not rise, colour fades with (1 - cos_d)^5, which the fit leaves out.
// What a texel needs are inner products with the basis BRDFs, worked out once a material: exact least squares at the price of a table.
#pragma once

#include <span>
#include <vector>

#include "processing/export/material_form.h"

namespace lumitexel {

class MaterialRefit {
 public:
  // What will be mixed. One or three channels; one is repeated.
  explicit MaterialRefit(const std::vector<Brdf>& basis, MaterialForm form = MaterialForm::Gltf);
  // The mixture sum over k of weights[k] * basis[k]; weights >= 0.
  GltfMaterial fit(std::span<const float> weights) const;

  static constexpr int kRoughnesses = 128;  // (i + 1) / 128: finer than the eye, and than what noise leaves

  struct Direction {
    LobeGeometry geometry;
    double weight = 0;  // solid angle of wi times the share of a sphere's picture that is seen at this angle
  };

 private:
  struct Products {
    double diffuse = 0, specular = 0;  // with the two basis functions of one roughness
  };
  struct Table {
    double roughness = 1, rise = 0, dd = 0, ds = 0, ss = 0, d_offset = 0, s_offset = 0, offset_offset = 0;
    std::vector<std::array<Products, 3>> with_basis;
    std::vector<std::array<double, 3>> offset_basis;
  };
  using BasisValues = std::vector<std::array<double, 3>>;  // by direction
  Table table_of(double roughness, double rise, const std::vector<Direction>& directions, const std::vector<BasisValues>& values) const;

  MaterialForm form_;

  std::vector<Table> tables_;
};

}  // namespace lumitexel
