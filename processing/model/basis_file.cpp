#include "processing/model/basis_file.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/brdf/lobe_family.h"
#include "processing/image/exr_file.h"

namespace lumitexel {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order written: the file is meant to be read

constexpr double kBoundSlack = 1e-9;                    // the bounds are rounded logarithms
constexpr double kAgreement = 1e-6;  // of a natural value with its logarithm; both are printed to full precision

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// What a family calls its lobes' parameters.
struct LobeKeys {
  const char *strength, *log_strength, *shape, *log_shape;
};

LobeKeys lobe_keys(BrdfFamily family) {
  switch (family) {
    case BrdfFamily::Ggx: return {"f0", "log_f0", "alpha", "log_alpha"};
    case BrdfFamily::Ward: return {"albedo", "log_albedo", "alpha", "log_alpha"};
    case BrdfFamily::Lafortune: break;
  }
  return {"peak", "log_peak", "exponent", "log_exponent"};
}

Json to_json(BrdfFamily family, const Lobe& lobe) {
  const LobeKeys keys = lobe_keys(family);
  Json json = {{keys.strength, finite_or_null(std::exp(lobe.log_strength))}};
  if (lobe_family(family).aims) json["phi_rad"] = lobe.aim;
  json[keys.shape] = std::exp(lobe.log_shape);
  json[keys.log_strength] = finite_or_null(lobe.log_strength);
  json[keys.log_shape] = lobe.log_shape;
  return json;
}

Json to_json(const Brdf& brdf) {
  Json diffuse = Json::array(), lobes = Json::array();
  const auto channels = static_cast<std::size_t>(brdf.channels);
  for (std::size_t c = 0; c < channels; ++c) diffuse.push_back(brdf.diffuse[c]);
  for (const auto& lobe : brdf.lobes) {
    Json entries = Json::array();
    for (std::size_t c = 0; c < channels; ++c) entries.push_back(to_json(brdf.family, lobe[c]));
    lobes.push_back(entries);
  }
  return {{"family", to_string(brdf.family)}, {"diffuse", diffuse}, {"lobes", lobes}};
}

Json to_json(BrdfFamily family, const LobeSigma& sigma) {
  const LobeKeys keys = lobe_keys(family);
  Json json = {{keys.log_strength, finite_or_null(sigma.log_strength)}};
  if (lobe_family(family).aims) json["phi_rad"] = finite_or_null(sigma.aim);
  json[keys.log_shape] = finite_or_null(sigma.log_shape);
  return json;
}

Json to_json(const Brdf& brdf, const BrdfSigma& sigma) {
  Json diffuse = Json::array(), lobes = Json::array();
  const auto channels = static_cast<std::size_t>(brdf.channels);
  for (std::size_t c = 0; c < channels; ++c) diffuse.push_back(finite_or_null(sigma.diffuse[c]));
  for (const auto& lobe : sigma.lobes) {
    Json entries = Json::array();
    for (std::size_t c = 0; c < channels; ++c) entries.push_back(to_json(brdf.family, lobe[c]));
    lobes.push_back(entries);
  }
  return {{"diffuse", diffuse}, {"lobes", lobes}};
}

Json rows_of(const ChannelMatrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(row);
  }
  return rows;
}

Json to_json(const ErrorModel& error) {
  Json correlation = nullptr;
  if (error.whitening().size() > 0) {
    const ChannelMatrix lower = error.whitening().inverse();
    correlation = rows_of(lower * lower.transpose());
  }
  return {{"relative", error.relative},
          {"floor", error.floor},
          {"freedom", error.freedom < ErrorModel::kGaussian ? Json(error.freedom) : Json(nullptr)},
          {"outlier_share", error.outlier_share},
          {"outlier_scale", error.outlier_scale},
          {"independence", error.independence},
          {"correlation", correlation}};
}

Json to_json(const std::vector<Brdf>& brdfs) {
  Json list = Json::array();
  for (const Brdf& brdf : brdfs) list.push_back(to_json(brdf));
  return list;
}

// A place in the document that knows its own name, for error messages.
class Field {
 public:
  Field(const Json& value, std::string name) : value_(value), name_(std::move(name)) {}

  Field operator[](const char* key) const {
    if (!value_.is_object() || !value_.contains(key)) fail("no \"" + std::string(key) + "\"", "that key");
    return {value_.at(key), name_ + "." + key};
  }
  std::vector<Field> elements() const {
    if (!value_.is_array()) fail(value_.dump(), "an array");
    std::vector<Field> all;
    for (std::size_t i = 0; i < value_.size(); ++i) all.emplace_back(value_[i], name_ + "[" + std::to_string(i) + "]");
    return all;
  }
  std::vector<Field> elements(int count) const {
    std::vector<Field> all = elements();
    if (all.size() != static_cast<std::size_t>(count)) {
      fail(std::to_string(all.size()) + " entries", std::to_string(count) + ", as many as there are channels, or lobes of the BRDF");
    }
    return all;
  }
  bool is_null() const { return value_.is_null(); }
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  BrdfFamily family() const {
    if (!value_.is_string()) fail(value_.dump(), "lafortune, ggx or ward");
    try {
      return brdf_family_from_string(value_.get<std::string>());
    } catch (const BadInput&) {
      fail(value_.dump(), "lafortune, ggx or ward");
    }
  }
  double number(double minimum, double maximum) const {
    const bool fits = value_.is_number() && value_.get<double>() >= minimum && value_.get<double>() <= maximum;
    if (!fits)
      fail(value_.dump(), "a finite number from " + std::to_string(minimum) + " to " + std::to_string(maximum));
    return value_.get<double>();
  }
  double sigma() const { return is_null() ? std::numeric_limits<double>::quiet_NaN() : number(0.0, std::numeric_limits<double>::max()); }
  double number() const {
    if (!value_.is_number() || !std::isfinite(value_.get<double>())) fail(value_.dump(), "a finite number");
    return value_.get<double>();
  }
  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw BadInput(name_, what, expected);
  }

 private:
  const Json& value_;
  std::string name_;
};

void check_agreement(const Field& natural, double logarithm) {
  const double expected = std::exp(logarithm);
  if (!std::isfinite(expected)) return;  // too large to be written
  if (!(std::abs(natural.number() - expected) <= kAgreement * expected)) {
    natural.fail(std::to_string(natural.number()), "the exponential of its logarithm, " + std::to_string(expected));
  }
}

Lobe lobe_from(BrdfFamily name, const Field& field) {
  const LobeKeys keys = lobe_keys(name);
  const LobeFamily& family = lobe_family(name);
  Lobe lobe;
  const Field log_strength = field[keys.log_strength];
  lobe.log_strength = log_strength.is_null() ? -std::numeric_limits<double>::infinity() : log_strength.number();
  if (family.aims) lobe.aim = field["phi_rad"].number(family.least_aim - kBoundSlack, family.most_aim + kBoundSlack);
  lobe.log_shape = field[keys.log_shape].number(family.least_log_shape - kBoundSlack, family.most_log_shape + kBoundSlack);
  check_agreement(field[keys.strength], lobe.log_strength);
  check_agreement(field[keys.shape], lobe.log_shape);
  return lobe;
}

Brdf brdf_from(const Field& field, int channels) {
  Brdf brdf;
  brdf.channels = channels;
  if (field.has("family")) brdf.family = field["family"].family();
  std::size_t c = 0;
  for (const Field& diffuse : field["diffuse"].elements(channels)) {
    const double kd = diffuse.number();
    if (kd < 0.0) diffuse.fail(std::to_string(kd), "0 or more");
    brdf.diffuse[c++] = kd;
  }
  for (const Field& entries : field["lobes"].elements()) {
    auto& lobe = brdf.lobes.emplace_back();
    c = 0;
    for (const Field& entry : entries.elements(channels)) lobe[c++] = lobe_from(brdf.family, entry);
  }
  return brdf;
}

BrdfSigma sigma_from(const Field& field, const Brdf& brdf) {
  const LobeKeys keys = lobe_keys(brdf.family);
  BrdfSigma sigma;
  std::size_t c = 0;
  for (const Field& diffuse : field["diffuse"].elements(brdf.channels)) sigma.diffuse[c++] = diffuse.sigma();
  for (const Field& entries : field["lobes"].elements(static_cast<int>(brdf.lobes.size()))) {
    auto& lobe = sigma.lobes.emplace_back();
    c = 0;
    for (const Field& entry : entries.elements(brdf.channels)) {
      const double aim = lobe_family(brdf.family).aims ? entry["phi_rad"].sigma() : std::numeric_limits<double>::quiet_NaN();
      lobe[c++] = {entry[keys.log_strength].sigma(), entry[keys.log_shape].sigma(), aim};
    }
  }
  return sigma;
}

ChannelMatrix matrix_from(const Field& field, int channels) {
  ChannelMatrix matrix(channels, channels);
  Eigen::Index r = 0;
  for (const Field& row : field.elements(channels)) {
    Eigen::Index c = 0;
    for (const Field& entry : row.elements(channels)) matrix(r, c++) = entry.number();
    ++r;
  }
  return matrix;
}

ErrorModel error_from(const Field& field, int channels) {
  constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::min();
  ErrorModel error(field["relative"].number(0.0, kMost), field["floor"].number(0.0, kMost));
  error.freedom = field["freedom"].is_null() ? ErrorModel::kGaussian : field["freedom"].number(kLeast, ErrorModel::kGaussian);
  error.outlier_share = field["outlier_share"].number(0.0, 1.0);
  error.outlier_scale = field["outlier_scale"].number(1.0, kMost);
  error.independence = field["independence"].number(0.0, 1.0);
  const Field correlation = field["correlation"];
  if (correlation.is_null()) return error;
  const ChannelMatrix matrix = matrix_from(correlation, channels);
  const bool usable = matrix.isApprox(matrix.transpose()) && matrix.llt().info() == Eigen::Success;
  if (!usable) correlation.fail("no such matrix", "a symmetric, positive definite one");
  error.set_correlation(matrix);
  return error;
}

std::vector<Brdf> brdfs_from(const Field& field, int channels) {
  std::vector<Brdf> brdfs;
  for (const Field& entry : field.elements()) brdfs.push_back(brdf_from(entry, channels));
  return brdfs;
}

Json to_json(const std::vector<ModelMaterial>& materials) {
  Json list = Json::array();
  for (const ModelMaterial& material : materials) {
    Json entry = {{"brdf", to_json(material.brdf)}};
    if (material.sigma) entry["sigma"] = to_json(material.brdf, *material.sigma);
    if (material.error) entry["error"] = to_json(*material.error);
    entry["basis"] = to_json(material.basis);
    if (!material.projection_basis.empty()) entry["projection_basis"] = to_json(material.projection_basis);
    list.push_back(entry);
  }
  return list;
}

std::vector<ModelMaterial> materials_from(const Field& field, int channels) {
  std::vector<ModelMaterial> materials;
  for (const Field& entry : field.elements()) {
    ModelMaterial material{brdf_from(entry["brdf"], channels), brdfs_from(entry["basis"], channels), {}};
    if (entry.has("sigma")) material.sigma = sigma_from(entry["sigma"], material.brdf);
    if (entry.has("error")) material.error = error_from(entry["error"], channels);
    if (entry.has("projection_basis")) material.projection_basis = brdfs_from(entry["projection_basis"], channels);
    materials.push_back(std::move(material));
  }
  return materials;
}

}  // namespace

std::string encode_basis(const Model& model) {
  Json document = {{"channels", colour_channel_names(model.channels)},
                   {"single", to_json(model.single)},
                   {"materials", to_json(model.materials)}};
  if (has_normals(model)) document["before_normals"] = to_json(model.before_normals->materials);
  return document.dump(1) + "\n";
}

BasisTable parse_basis(const std::string& text, int channels, const std::string& where) {
  const Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) throw BadInput(where, "not JSON", "the basis table of a model");
  const Field root(document, where);
  root["channels"].elements(channels);
  BasisTable table;
  table.single = brdf_from(root["single"], channels);
  table.materials = materials_from(root["materials"], channels);
  if (root.has("before_normals")) table.before_normals = materials_from(root["before_normals"], channels);
  return table;
}

}  // namespace lumitexel
