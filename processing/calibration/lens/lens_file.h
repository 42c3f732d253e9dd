// A lens calibration on disk: JSON, with a fingerprint of what it is about and a day on which it expires.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "drivers/camera.h"
#include "processing/calibration/lens/lens_calibration.h"
#include "processing/calibration/lens/vignetting.h"

namespace lumitexel {

struct LensRecord {
  std::string camera_name;  // what the camera and lens call themselves, focus and aperture included; may be empty
  Mosaic mosaic = Mosaic::Mono;
  std::int64_t made_utc_s = 0;  // seconds since 1970-01-01 UTC
  double expires_after_days = 30;
  CameraModel camera;
  LensMatrix covariance = LensMatrix::Zero();
  double rms_px = 0, reduced_chi2 = 0;
  int boards_used = 0, boards_rejected = 0;
  LensCoverage coverage;
  std::optional<Vignetting> vignetting;
};

// What a usable calibration says; name, mosaic, day and vignetting are the caller's to fill in.
LensRecord lens_record(const LensCalibration& calibration);

// SHA-256 over the camera's name, size and mosaic, the model, its covariance and the vignetting, bit for bit, and the
// time it was made: what sessions and models note down as the lens they were made with.
std::string lens_fingerprint(const LensRecord& record);

bool lens_expired(const LensRecord& record, std::int64_t now_utc_s);

// Why the record is not for this camera ("its calibration is of 6000 x 4000 pixels, …"); empty if it is. A name is
// compared only if both have one.
std::string lens_mismatch(const LensRecord& record, const std::string& camera_name, const CameraLimits& limits);

// Whole or not at all. Throws Error if it cannot be written.
void write_lens_file(const std::filesystem::path& path, const LensRecord& record);
// Throws BadInput if there is no such file; Corrupt naming it if it is not a lens file of this version, or if its
// contents are not those that its fingerprint was made of.
LensRecord read_lens_file(const std::filesystem::path& path);
// The same of a file's text; `where` names it in errors.
LensRecord parse_lens_record(const std::string& text, const std::string& where);

}  // namespace lumitexel
