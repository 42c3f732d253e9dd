#include "processing/calibration/lens/lens_file.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "rig/durable_file.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

using nlohmann::json;
constexpr int kVersion = 1;

template <typename Matrix>
json numbers(const Matrix& matrix) {
  json list = json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) list.push_back(matrix(r, c));
  }
  return list;
}

template <typename Matrix>
Matrix matrix_from(const json& list) {
  Matrix matrix;
  if (!list.is_array() || list.size() != static_cast<std::size_t>(matrix.size()))
    throw Corrupt("a matrix of another size");
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix(i / matrix.cols(), i % matrix.cols()) = list[static_cast<std::size_t>(i)].get<double>();
  }
  return matrix;
}

// What the fingerprint covers. Doubles are written so that they read back bit for bit.
json identity(const LensRecord& r) {
  json j = {{"camera_name", r.camera_name},        {"width_px", r.camera.width_px},
            {"height_px", r.camera.height_px},     {"mosaic", to_string(r.mosaic)},
            {"made_utc_s", r.made_utc_s},          {"params", numbers(lens_vector(r.camera))},
            {"covariance", numbers(r.covariance)}, {"vignetting", nullptr}};
  if (r.vignetting) {
    const Vignetting& v = *r.vignetting;
    j["vignetting"] = {{"principal_px", {v.principal_x_px, v.principal_y_px}},
                       {"half_diagonal_px", v.half_diagonal_px},
                       {"terms", numbers(v.terms)},
                       {"covariance", numbers(v.covariance)}};
  }
  return j;
}

LensRecord record_from(const json& j) {
  LensRecord r;
  r.camera_name = j.at("camera_name").get<std::string>();
  r.mosaic = mosaic_from_string(j.at("mosaic").get<std::string>());
  r.made_utc_s = j.at("made_utc_s").get<std::int64_t>();
  r.expires_after_days = j.at("expires_after_days").get<double>();
  r.camera.width_px = j.at("width_px").get<int>();
  r.camera.height_px = j.at("height_px").get<int>();
  r.camera = with_lens_vector(r.camera, matrix_from<LensVector>(j.at("params")));
  r.covariance = matrix_from<LensMatrix>(j.at("covariance"));
  r.rms_px = j.at("rms_px").get<double>();
  r.reduced_chi2 = j.at("reduced_chi2").get<double>();
  r.boards_used = j.at("boards_used").get<int>();
  r.boards_rejected = j.at("boards_rejected").get<int>();
  r.coverage.columns = j.at("coverage").at("columns").get<int>();
  r.coverage.rows = j.at("coverage").at("rows").get<int>();
  r.coverage.counts = j.at("coverage").at("counts").get<std::vector<int>>();
  if (const json& v = j.at("vignetting"); !v.is_null()) {
    Vignetting& to = r.vignetting.emplace();
    to.principal_x_px = v.at("principal_px").at(0).get<double>();
    to.principal_y_px = v.at("principal_px").at(1).get<double>();
    to.half_diagonal_px = v.at("half_diagonal_px").get<double>();
    to.terms = matrix_from<Eigen::Vector3d>(v.at("terms"));
    to.covariance = matrix_from<Eigen::Matrix3d>(v.at("covariance"));
  }
  return r;
}

}  // namespace

LensRecord lens_record(const LensCalibration& calibration) {
  LensRecord record;
  record.camera = calibration.camera;
  record.covariance = calibration.covariance;
  record.rms_px = calibration.rms_px;
  record.reduced_chi2 = calibration.reduced_chi2;
  for (const BoardFit& board : calibration.boards)
    ++(board.rejected.empty() ? record.boards_used : record.boards_rejected);
  record.coverage = calibration.coverage;
  return record;
}

std::string lens_fingerprint(const LensRecord& record) { return sha256_hex(identity(record).dump()); }

bool lens_expired(const LensRecord& record, std::int64_t now_utc_s) {
  constexpr double kDay_s = 86400.0;
  return static_cast<double>(now_utc_s - record.made_utc_s) >= record.expires_after_days * kDay_s;
}

std::string lens_mismatch(const LensRecord& record, const std::string& camera_name, const CameraLimits& limits) {
  const auto size = [](int w, int h, Mosaic mosaic) {
    return std::to_string(w) + " x " + std::to_string(h) + " pixels, " + to_string(mosaic);
  };
  const std::string calibrated = size(record.camera.width_px, record.camera.height_px, record.mosaic);
  const std::string present = size(limits.width_px, limits.height_px, limits.mosaic);
  if (calibrated != present) return "the lens calibration is of " + calibrated + ", the camera has " + present;
  if (!camera_name.empty() && !record.camera_name.empty() && camera_name != record.camera_name)
    return "the lens calibration is of '" + record.camera_name + "', the camera is '" + camera_name + "'";
  return "";
}

void write_lens_file(const std::filesystem::path& path, const LensRecord& record) {
  json j = identity(record);
  j["version"] = kVersion;
  j["fingerprint"] = lens_fingerprint(record);
  j["expires_after_days"] = record.expires_after_days;
  j["rms_px"] = record.rms_px;
  j["reduced_chi2"] = record.reduced_chi2;
  j["boards_used"] = record.boards_used;
  j["boards_rejected"] = record.boards_rejected;
  j["coverage"] = {
      {"columns", record.coverage.columns}, {"rows", record.coverage.rows}, {"counts", record.coverage.counts}};
  write_durably(path, j.dump(1) + "\n");
}

LensRecord read_lens_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw BadInput(path.string(), "cannot be opened", "a lens calibration's JSON file");
  return parse_lens_record(std::string{std::istreambuf_iterator<char>(file), {}}, path.string());
}

LensRecord parse_lens_record(const std::string& text, const std::string& where) {
  try {
    const json j = json::parse(text);
    if (j.at("version").get<int>() != kVersion) throw Corrupt("another version");
    const LensRecord record = record_from(j);
    if (j.at("fingerprint").get<std::string>() != lens_fingerprint(record))
      throw Corrupt("its contents are not those of its fingerprint");
    return record;
  } catch (const std::exception& error) {
    throw Corrupt(where + ": no lens calibration of version " + std::to_string(kVersion) + ": " + error.what());
  }
}

}  // namespace lumitexel
