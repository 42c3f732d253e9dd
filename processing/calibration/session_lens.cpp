#include "processing/calibration/session_lens.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "processing/calibration/lens/board_detection.h"
#include "processing/calibration/lens/check_lens.h"
#include "processing/calibration/lens/lens_pictures.h"
#include "processing/calibration/lens/lens_prior.h"
#include "processing/calibration/lens/lens_sigma.h"
#include "processing/image/raster_file.h"

namespace lumitexel {
namespace {

constexpr int kPictureWidth_px = 640;

void keep_picture(const std::filesystem::path& directory, const std::string& name, const Image& picture,
                  CalibrationSummary& summary) {
  write_png8(directory / name, picture);
  summary.pictures.push_back(name);
}

std::vector<BoardSighting> see_boards(const std::vector<FrameRecord>& shots, const std::vector<int>& placements,
                                      const BoardDescription& board, const RadianceReader& reader, Progress& progress) {
  progress.begin("calibration board", static_cast<std::int64_t>(shots.size()), "shots");
  std::vector<BoardSighting> sightings(shots.size());
  std::atomic<std::int64_t> done{0};
  tbb::parallel_for(std::size_t{0}, shots.size(), [&](std::size_t i) {
    sightings[i] = detect_board(reader.read(shots[i]), board, "placement " + std::to_string(placements[i]));
    progress.update(++done);
  });
  return sightings;
}

void describe(const LensCalibration& calibration, LensSummary& lens) {
  lens.notes = calibration.warnings;
  for (const BoardFit& board : calibration.boards) {
    if (!board.rejected.empty()) lens.notes.push_back(board.name + ": " + board.rejected);
  }
  if (!calibration.usable()) {
    lens.notes.emplace_back("boards: " + calibration.refusal);
    return;
  }
  lens.source = "boards of this session";  // in place of a lens calibrated before, if that was taken
  lens.boards = 0;
  lens.reprojection_px = calibration.rms_px;
  for (const BoardFit& board : calibration.boards) lens.boards += board.rejected.empty();
}

// What a lens calibrated before is worth today; empty if it may be used.
std::string objection_to(const LensRecord& record, const CapturedInputs& in, std::int64_t taken_utc_s,
                         const std::optional<LensCheck>& check) {
  const std::string mismatch = lens_mismatch(record, "", in.rig.camera.limits);
  if (!mismatch.empty()) return mismatch;
  if (check && check->verdict == LensVerdict::Changed) return "the check shots say that it has changed: " + check->reason;
  const bool confirmed = check && check->verdict == LensVerdict::Holds;
  if (!confirmed && lens_expired(record, taken_utc_s)) {
    return "it had expired, and no check shot says that it still holds: photograph the board in three placements or more";
  }
  return {};
}

void take_record(const LensRecord& record, const CapturedInputs& in, std::int64_t taken_utc_s,
                 const std::vector<BoardSighting>& sightings, SessionLens& lens, LensSummary& summary) {
  std::optional<LensCheck> check;
  if (!sightings.empty()) {
    check = check_lens(record.camera, record.covariance, sightings);
    summary.notes.push_back(std::string("check of the lens calibration: ") + to_string(check->verdict) + "; " + check->reason);
  }
  const std::string objection = objection_to(record, in, taken_utc_s, check);
  if (!objection.empty()) {
    summary.notes.push_back("the lens calibration is not used: " + objection);
    return;
  }
  lens.camera = record.camera;
  lens.covariance = record.covariance;
  lens.vignetting = record.vignetting;
  summary.source = "lens calibration " + lens_fingerprint(record).substr(0, 12);
  summary.reprojection_px = record.rms_px;
  summary.boards = record.boards_used;
}

// Fewer boards than this check a lens, they do not calibrate one, where one calibrated before is at hand.
constexpr std::size_t kEnoughToCalibrate = 5;

void measure_boards(const std::vector<int>& placements, const std::vector<BoardSighting>& sightings,
                    const CapturedInputs& in, const std::filesystem::path& directory, SessionLens& lens,
                    CalibrationSummary& summary) {
  const LensCalibration calibration = calibrate_lens(in.nominal_camera.width_px, in.nominal_camera.height_px, sightings,
                                                     lens_prior_of(in.rig.camera));
  describe(calibration, summary.lens);
  if (!calibration.usable()) return;
  lens.camera = calibration.camera;
  lens.covariance = calibration.covariance;
  lens.record = lens_record(calibration);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (calibration.boards[i].rejected.empty()) {
      lens.camera_from_board[placements[i]] = calibration.boards[i].camera_from_board;
    }
  }
  keep_picture(directory, "lens_coverage.png", coverage_picture(calibration, sightings, kPictureWidth_px), summary);
}

void measure_vignetting(const CapturedFrames& frames, const RadianceReader& reader,
                        const std::filesystem::path& directory, SessionLens& lens, CalibrationSummary& summary,
                        Progress& progress) {
  const std::vector<FrameRecord> shots = frames.of(ShotKind::FlatField);
  progress.begin("flat fields", static_cast<std::int64_t>(shots.size()), "shots");
  std::vector<MosaicRadiance> flats;
  for (const FrameRecord& shot : shots) {
    flats.push_back(reader.read(shot));
    progress.update(static_cast<std::int64_t>(flats.size()));
  }
  const VignettingFit fit = fit_vignetting(flats, lens.camera);
  if (!fit.usable) {
    summary.lens.notes.emplace_back("flat fields: too little of them is usable");
    return;
  }
  if (fit.terms == 0) {
    summary.lens.notes.emplace_back("flat fields: they ask for no vignetting");
    return;
  }
  lens.vignetting = fit.vignetting;
  summary.lens.corner_transmission = fit.vignetting.transmission({0.0, 0.0});
  summary.lens.corner_transmission_sigma = fit.vignetting.sigma({0.0, 0.0});
  keep_picture(directory, "vignetting.png", vignetting_picture(fit.vignetting, lens.camera, kPictureWidth_px), summary);
}

// The lens as a file that later sessions can be given.
void keep_record(const CapturedFrames& frames, const CapturedInputs& in, const std::filesystem::path& directory,
                 SessionLens& lens) {
  if (!lens.record) return;
  lens.record->mosaic = in.rig.camera.limits.mosaic;
  lens.record->made_utc_s = frames.begun_utc_ns() / 1'000'000'000;
  lens.record->vignetting = lens.vignetting;
  write_lens_file(directory / "lens.json", *lens.record);
}

}  // namespace

void state_lens(const SessionLens& lens, LensSummary& summary) {
  const LensVector params = lens_vector(lens.camera);
  summary.params.assign(params.begin(), params.end());
  if (!lens.covariance) return;
  const LensVector sigma = lens.covariance->diagonal().cwiseSqrt();
  summary.sigma.assign(sigma.begin(), sigma.end());
  summary.corner_sigma_px = corner_sigma_px(lens.camera, *lens.covariance);
}

SessionLens measure_lens(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                         const CalibrationOptions& options, const std::filesystem::path& directory,
                         CalibrationSummary& summary, Progress& progress) {
  SessionLens lens{in.nominal_camera, std::nullopt, std::nullopt, {}, std::nullopt};
  if (options.takes(CalibrationStep::Lens)) {
    std::vector<BoardSighting> sightings;
    std::vector<int> placements;
    if (in.rig.board && frames.has(ShotKind::Board)) {
      placements = frames.indices_of(ShotKind::Board);
      sightings = see_boards(frames.of(ShotKind::Board), placements, *in.rig.board, reader, progress);
    }
    if (in.lens) take_record(*in.lens, in, frames.begun_utc_ns() / 1'000'000'000, sightings, lens, summary.lens);
    if (sightings.size() >= kEnoughToCalibrate || (!in.lens && !sightings.empty())) {
      measure_boards(placements, sightings, in, directory, lens, summary);
    }
  }
  if (frames.has(ShotKind::FlatField) && options.takes(CalibrationStep::Vignetting)) {
    measure_vignetting(frames, reader, directory, lens, summary, progress);
  }
  if (!options.takes(CalibrationStep::Vignetting)) lens.vignetting.reset();
  state_lens(lens, summary.lens);
  keep_record(frames, in, directory, lens);
  return lens;
}

}  // namespace lumitexel
