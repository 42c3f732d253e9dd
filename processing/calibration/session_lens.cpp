#include "processing/calibration/session_lens.h"

#include <tbb/parallel_for.h>

#include "processing/calibration/lens/board_detection.h"
#include "processing/calibration/lens/lens_pictures.h"
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
  lens.source = "boards of this session";
  lens.reprojection_px = calibration.rms_px;
  for (int i = 0; i < kLensParameters; ++i) lens.sigma.push_back(std::sqrt(calibration.covariance(i, i)));
  for (const BoardFit& board : calibration.boards) lens.boards += board.rejected.empty();
}

void measure_boards(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                    const std::filesystem::path& directory, SessionLens& lens, CalibrationSummary& summary,
                    Progress& progress) {
  const std::vector<FrameRecord> shots = frames.of(ShotKind::Board);
  const std::vector<int> placements = frames.indices_of(ShotKind::Board);
  const std::vector<BoardSighting> sightings = see_boards(shots, placements, *in.rig.board, reader, progress);
  const LensCalibration calibration =
      calibrate_lens(in.nominal_camera.width_px, in.nominal_camera.height_px, sightings);
  describe(calibration, summary.lens);
  if (!calibration.usable()) return;
  lens.camera = calibration.camera;
  lens.covariance = calibration.covariance;
  for (std::size_t i = 0; i < shots.size(); ++i) {
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

}  // namespace

SessionLens measure_lens(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                         const CalibrationOptions& options, const std::filesystem::path& directory,
                         CalibrationSummary& summary, Progress& progress) {
  SessionLens lens{in.nominal_camera, std::nullopt, std::nullopt, {}};
  if (in.rig.board && frames.has(ShotKind::Board) && options.takes(CalibrationStep::Lens)) {
    measure_boards(frames, in, reader, directory, lens, summary, progress);
  }
  if (frames.has(ShotKind::FlatField) && options.takes(CalibrationStep::Vignetting)) {
    measure_vignetting(frames, reader, directory, lens, summary, progress);
  }
  return lens;
}

}  // namespace lumitexel
