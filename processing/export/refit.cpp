#include "processing/export/refit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kViewAngles_deg[] = {5, 15, 25, 35, 45};  // where most of a picture is seen
constexpr int kTilts = 36, kTurns = 6;
constexpr double kLeastTilt = 2e-3, kTiltRatio = 1.215;  // up to 1.85 rad; what leaves the hemisphere is dropped
constexpr double kMostF0 = 0.98;                         // leaves diffuse light something to be divided by

// How far F rises from F0 towards 1 at grazing angles: not at all, or as Schlick has it.
constexpr double kRises[] = {0.0, 1.0};

using Direction = MaterialRefit::Direction;

std::vector<Direction> sampled_directions() {
  std::vector<Direction> directions;
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  for (const double angle_deg : kViewAngles_deg) {
    const Eigen::Vector3d wo(std::sin(angle_deg * kDegree), 0.0, std::cos(angle_deg * kDegree));
    for (int t = 0; t < kTilts; ++t) {
      const double tilt = kLeastTilt * std::pow(kTiltRatio, t);
      if (tilt >= 0.5 * std::numbers::pi) break;
      for (int p = 0; p < kTurns; ++p) {
        const double turn = std::numbers::pi * (p + 0.5) / kTurns;  // the other half is its mirror image
        const Eigen::Vector3d half(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
        const double cos_d = half.dot(wo);
        const Eigen::Vector3d wi = (2.0 * cos_d * half - wo).normalized();
        if (cos_d <= 0.0 || wi.z() <= 0.02) continue;
        directions.push_back({lobe_geometry(normal, wi, wo), 4.0 * cos_d * std::sin(tilt) * tilt * std::sin(angle_deg * kDegree) * wo.z()});
      }
    }
  }
  return directions;
}

std::array<double, 3> three_channels(const Brdf& brdf, const LobeGeometry& geometry) {
  const ChannelValues values = evaluate(brdf, geometry);
  if (brdf.channels == 1) return {values[0], values[0], values[0]};
  return values;
}

struct Pair {
  double diffuse = 0, specular = 0;
};

// The smallest of the quadratic with both unknowns at least zero and the specular at most kMostF0.
Pair bounded_minimum(double dd, double ds, double ss, double d, double s) {
  const double determinant = dd * ss - ds * ds;
  double specular = determinant > 1e-12 * dd * ss ? (dd * s - ds * d) / determinant : 0.0;
  specular = std::clamp(specular, 0.0, kMostF0);
  double diffuse = (d - ds * specular) / dd;
  if (diffuse < 0.0) {
    diffuse = 0.0;
    specular = std::clamp(s / ss, 0.0, kMostF0);
  }
  return {diffuse, specular};
}

}  // namespace

MaterialRefit::MaterialRefit(const std::vector<Brdf>& basis, MaterialForm form) : form_(form) {
  const std::vector<Direction> directions = sampled_directions();
  std::vector<BasisValues> values(basis.size());
  for (const Direction& direction : directions) {
    for (std::size_t k = 0; k < basis.size(); ++k) values[k].push_back(three_channels(basis[k], direction.geometry));
  }
  for (const double rise : kRises) {
    if (rise > 0.0 && form == MaterialForm::Mitsuba) continue;
    for (int i = 0; i < kRoughnesses; ++i) tables_.push_back(table_of((i + 1.0) / kRoughnesses, rise, directions, values));
  }
}

MaterialRefit::Table MaterialRefit::table_of(double roughness, double rise, const std::vector<Direction>& directions,
                                             const std::vector<BasisValues>& values) const {
  Table table;
  table.roughness = roughness;
  table.rise = rise;
  table.with_basis.resize(values.size());
  table.offset_basis.resize(values.size());
  for (std::size_t n = 0; n < directions.size(); ++n) {
    const GltfFacets highlight = facets(form_, roughness, directions[n].geometry);
    const double fall = rise * highlight.fall;
    const double diffuse = 1.0 - fall, specular = highlight.value * (1.0 - fall);
    const double offset = highlight.value * fall, cos_i = directions[n].geometry.cos_i;
    const double weight = directions[n].weight * cos_i * cos_i;
    table.dd += weight * diffuse * diffuse;
    table.ds += weight * diffuse * specular;
    table.ss += weight * specular * specular;
    table.d_offset += weight * diffuse * offset;
    table.s_offset += weight * specular * offset;
    table.offset_offset += weight * offset * offset;
    for (std::size_t k = 0; k < values.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        table.with_basis[k][c].diffuse += weight * diffuse * values[k][n][c];
        table.with_basis[k][c].specular += weight * specular * values[k][n][c];
        table.offset_basis[k][c] += weight * offset * values[k][n][c];
      }
    }
  }
  return table;
}

GltfMaterial MaterialRefit::fit(std::span<const float> weights) const {
  GltfMaterial best;
  double least = std::numeric_limits<double>::infinity();
  for (const Table& table : tables_) {
    double misfit = 0.0;  // less the mixture's own square, which is the same at every roughness
    std::array<Pair, 3> found;
    for (std::size_t c = 0; c < 3; ++c) {
      double d = -table.d_offset, s = -table.s_offset, o = 0.0;
      for (std::size_t k = 0; k < table.with_basis.size(); ++k) {
        d += weights[k] * table.with_basis[k][c].diffuse;
        s += weights[k] * table.with_basis[k][c].specular;
        o += weights[k] * table.offset_basis[k][c];
      }
      const Pair x = found[c] = bounded_minimum(table.dd, table.ds, table.ss, d, s);
      misfit += table.dd * x.diffuse * x.diffuse + 2.0 * table.ds * x.diffuse * x.specular +
                table.ss * x.specular * x.specular - 2.0 * (d * x.diffuse + s * x.specular) + table.offset_offset - 2.0 * o;
    }
    if (!(misfit < least)) continue;
    least = misfit;
    const double largest = std::max({found[0].specular, found[1].specular, found[2].specular});
    best.roughness = table.roughness;
    best.specular = largest + table.rise * (1.0 - largest);
    for (std::size_t c = 0; c < 3; ++c) {
      best.f0[c] = found[c].specular;
      best.base[c] = std::clamp(std::numbers::pi * found[c].diffuse / (1.0 - largest), 0.0, 1.0);
    }
  }
  return best;
}

}  // namespace lumitexel
