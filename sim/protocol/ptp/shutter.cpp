#include "sim/protocol/ptp/shutter.h"

#include <array>
#include <cstdio>

#include "drivers/error.h"
#include "drivers/gphoto/frame_name.h"
#include "sim/protocol/ptp/dng_writer.h"

namespace lumitexel::ptp {
namespace {

std::string file_name(std::uint32_t number) {
  std::array<char, 32> name;
  std::snprintf(name.data(), name.size(), "IMG_%04u.DNG", number % 10000);
  return name.data();
}

}  // namespace

Shutter::Shutter(std::shared_ptr<SimulatedBench> bench, MemoryCard& card, ShutterIdentity identity, Finished finished)
    : bench_(std::move(bench)),
      card_(card),
      identity_(std::move(identity)),
      finished_(std::move(finished)),
      thread_([this](std::stop_token stop) { run(stop); }) {}

bool Shutter::release(const Release& release) {
  const std::lock_guard lock(mutex_);
  if (busy_) return false;
  busy_ = true;
  waiting_ = release;
  wake_.notify_all();
  return true;
}

bool Shutter::has_picture() const {
  const std::lock_guard lock(mutex_);
  return last_file_ != nullptr;
}

void Shutter::run(std::stop_token stop) {
  while (true) {
    std::unique_lock lock(mutex_);
    if (!wake_.wait(lock, stop, [this] { return waiting_.has_value(); })) return;
    const Release release = *waiting_;
    waiting_.reset();
    lock.unlock();
    try {
      take(release, stop);
    } catch (const Cancelled&) {
      return;
    }
  }
}

void Shutter::take(const Release& release, std::stop_token stop) {
  StoredPicture picture = expose(release, stop);
  {
    const std::lock_guard lock(mutex_);
    if (release.fault == Fault::StaleFrame && last_file_) {
      picture.file = last_file_;
    } else {
      last_file_ = picture.file;
    }
    earlier_ = release;
    busy_ = false;
  }
  const std::uint32_t handle = card_.add(std::move(picture));
  finished_(release, handle, stop);
}

StoredPicture Shutter::expose(const Release& release, std::stop_token stop) {
  Release used = release;
  if (release.fault == Fault::LateSettings && earlier_) {
    used.settings = earlier_->settings;
    used.iso = earlier_->iso;
  }
  const std::uint32_t number = ++pictures_;
  const std::uint64_t key = frame_key_of(release.artist).value_or(number);
  const BenchExposure exposure = bench_->expose(used.settings, key, stop);
  const CameraDescription& camera = bench_->camera();
  DngContent content;
  content.width_px = camera.limits.width_px;
  content.height_px = camera.limits.height_px;
  content.bits = camera.limits.bits;
  content.mosaic = camera.limits.mosaic;
  content.samples = exposure.samples;
  content.black_level_dn = camera.sensor.black_level_dn;
  // A lie of a stop: as a camera that reports its dial's new place and took the picture with the old one.
  content.exposure_s = used.settings.exposure_s * (release.fault == Fault::FalseMetadata ? 2.0 : 1.0);
  content.iso = used.iso;
  content.f_number = used.f_number;
  content.make = identity_.make;
  content.model = identity_.model;
  content.serial = identity_.serial;
  content.artist = release.artist;
  content.utc_ns = bench_->clock()->utc_ns();
  content.image_number = number;
  content.temperature_c = bench_->behaviour().sensor_temperature_c + exposure.state.sensor_warming_k;
  return {file_name(number), content.width_px, content.height_px,
          std::make_shared<const std::vector<std::uint8_t>>(write_dng(content))};
}

}  // namespace lumitexel::ptp
