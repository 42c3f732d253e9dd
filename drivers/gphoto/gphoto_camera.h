// A DSLR or mirrorless camera through libgphoto2, delivering camera raw files.
//
// Tried: a simulated camera over PTP/IP (sim/protocol/ptp), through libgphoto2's real ptp2 driver. Canon, Nikon, Sony
// or Fuji bodies and USB: not yet tried.
//
//   arm      exposure and ISO are set by the text of one of the camera's own choices and read back
//   trigger  names the frame if the camera can, releases the shutter, fetches the file, deletes it on the card, decodes
//   it recover  kills the worker process (gphoto_process.h), connects anew, makes the fixed settings again
//
// Dials write rounded numbers ("1/30" for 0.0333 s): a choice or an EXIF value within kDialTolerance of what was asked
// for is taken to be it, and reported as it; exposure_choice.h says why. What a dial's place really lasts is for
// calibration to find.
//
// Without frame_name_setting, a picture whose shutter was released for a shot that was then cancelled could be taken
// for the next shot's, if its report comes late enough and its settings are the same. With it, no frame of another shot
// is accepted.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "drivers/camera.h"
#include "drivers/clock.h"
#include "drivers/gphoto/remote_camera.h"

namespace lumitexel {

struct CameraRaw;

class GphotoCamera final : public Camera {
 public:
  // Connects. limits: the camera's, as its raw files really are (camera_raw.h on their size). clock: a real one.
  // worker: the program lumitexel-gphoto-worker. Throws BadInput without a worker, Disconnected if the camera is not
  // reached within reconnect_timeout_s, OutOfRange for a model or a port that libgphoto2 does not know; BadInput, too,
  // for exposure_choices_s that are not all on the camera's dial.
  GphotoCamera(const GphotoConnection& connection, const CameraLimits& limits, std::shared_ptr<Clock> clock,
               const std::filesystem::path& worker = default_gphoto_worker());

  std::string name() const override { return name_; }
  CameraLimits limits() const override { return limits_; }
  pid_t worker_pid() const { return remote_.worker_pid(); }  // 0: none runs

 protected:
  // Throws OutOfRange, listing the camera's choices, if none is what was asked for.
  CameraSettings arm(const CameraSettings& settings, std::stop_token stop) override;
  // device_time_s: EXIF's DateTimeOriginal. A camera that writes whole seconds may take several pictures in one; each
  // is then put a millisecond after the one before, so that time goes on. Without any date: this clock's time at
  // arrival. device_frame_id: EXIF's image number, else a hash of the file, which no two exposures share.
  // sensor_temperature_c stays 0 where the file tells none.
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override;
  void recover(std::stop_token stop) override;
  double longest_recovery_s() const override;

 private:
  double iso_of(double gain_db) const;
  double gain_db_of(double iso) const;
  double select(const std::string& setting, const std::vector<std::string>& choices,
                std::optional<double> (*parse)(const std::string&), double wanted, std::stop_token stop);
  CameraRaw decoded(const DownloadedPicture& picture) const;
  CameraSettings reported_by(const CameraRaw& raw, const std::string& file) const;
  std::optional<std::uint64_t> key_in(const CameraRaw& raw, const std::string& file) const;
  double time_of(const CameraRaw& raw);

  std::string name_;
  GphotoConnection connection_;
  CameraLimits limits_;
  std::shared_ptr<Clock> clock_;
  RemoteCamera remote_;
  CameraSettings armed_;
  double last_time_s_ = 0.0;
};

}  // namespace lumitexel
