#include "sim/sgd_brdf.h"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <vector>

#include "drivers/error.h"

namespace lumitexel {
namespace {

double shadowing(const SgdBrdf& brdf, int channel, double theta) {
  const double beyond = std::max(0.0, theta - brdf.theta0[channel]);
  const double value =
      1.0 + brdf.lambda[channel] * (1.0 - std::exp(brdf.c[channel] * std::pow(beyond, brdf.k[channel])));
  return std::clamp(value, 0.0, 1.0);
}

std::vector<std::string> split_at_commas(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

struct Row {
  std::vector<std::string> columns, fields;
};

std::optional<Row> find_row(std::string_view csv, const std::string& material) {
  std::stringstream stream{std::string(csv)};
  Row row;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> fields = split_at_commas(line);
    if (row.columns.empty()) {
      row.columns = std::move(fields);
    } else if (fields.front() == material) {
      row.fields = std::move(fields);
      return row;
    }
  }
  return std::nullopt;
}

double number(const std::string& text, const std::string& where) {
  std::size_t used = 0;
  double value = std::nan("");
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || !std::isfinite(value)) throw BadInput(where, "'" + text + "'", "a finite number");
  return value;
}

}  // namespace

Eigen::Array3d evaluate(const SgdBrdf& brdf, const LobeGeometry& geometry, double albedo_scale) {
  const double cos_i = geometry.cos_i, cos_o = geometry.cos_o;
  if (!(cos_i > 0.0 && cos_o > 0.0)) return Eigen::Array3d::Zero();
  const double half_length_sq = 2.0 + 2.0 * geometry.wi_dot_wo();  // |wi + wo|^2
  const double cos_h_sq = std::min(1.0, (cos_i + cos_o) * (cos_i + cos_o) / half_length_sq);
  const double tan_h_sq = (1.0 - cos_h_sq) / cos_h_sq;
  const double cos_d = std::min(1.0, 0.5 * std::sqrt(half_length_sq));
  const double theta_i = std::acos(std::min(1.0, cos_i)), theta_o = std::acos(std::min(1.0, cos_o));
  const double schlick = std::pow(1.0 - cos_d, 5);
  Eigen::Array3d f;
  for (int channel = 0; channel < 3; ++channel) {
    const double a = brdf.alpha[channel] + tan_h_sq / brdf.alpha[channel];
    const double distribution = brdf.kap[channel] * std::exp(-a) /
                                (std::numbers::pi * std::pow(a, brdf.p[channel]) * cos_h_sq * cos_h_sq);
    double specular = 0.0;
    // Below this the lobe adds nothing that a double could hold beside the diffuse part; it spares the powers of G.
    if (distribution > 1e-12) {
      const double fresnel =
          std::max(0.0, brdf.f0[channel] - cos_d * brdf.f1[channel] + schlick * (1.0 - brdf.f0[channel]));
      specular = brdf.rho_s[channel] * fresnel * distribution * shadowing(brdf, channel, theta_i) *
                 shadowing(brdf, channel, theta_o) / (cos_i * cos_o);
    }
    f[channel] = (brdf.rho_d[channel] * albedo_scale + specular) / std::numbers::pi;
  }
  return f;
}

SgdBrdf sgd_from_table(std::string_view csv, const std::string& material, const std::string& where) {
  const std::optional<Row> row = find_row(csv, material);
  if (!row) throw BadInput(where, "no material '" + material + "'", "a row of that name");
  std::map<std::string, std::string> cells;
  for (std::size_t i = 0; i < row->columns.size() && i < row->fields.size(); ++i) {
    cells[row->columns[i]] = row->fields[i];
  }
  const auto column = [&](const std::string& name) {
    Eigen::Array3d values;
    const char* const suffixes[3] = {"_r", "_g", "_b"};
    for (int channel = 0; channel < 3; ++channel) {
      const std::string key = name + suffixes[channel];
      values[channel] = number(cells[key], where + ": " + material + ", column " + key);
    }
    return values;
  };
  return {column("rhoD"), column("rhoS"), column("alpha"),  column("p"), column("F0"), column("F1"),
          column("kap"),  column("lambda"), column("c"), column("k"), column("theta0")};
}

std::vector<std::string> sgd_table_names(std::string_view csv) {
  std::stringstream stream{std::string(csv)};
  std::vector<std::string> names;
  bool header = true;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (!header) names.push_back(split_at_commas(line).front());
    header = false;
  }
  return names;
}

bool sgd_table_has(std::string_view csv, const std::string& material) {
  return find_row(csv, material).has_value();
}

}  // namespace lumitexel
