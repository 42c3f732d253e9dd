// The simulated camera's card: raw files by handle. Thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sim/protocol/ptp/packet.h"

namespace lumitexel::ptp {

struct StoredPicture {
  std::string name;  // "IMG_0001.DNG"
  int width_px = 0, height_px = 0;
  SharedBytes file;
};

class MemoryCard {
 public:
  std::uint32_t add(StoredPicture picture) {
    const std::lock_guard lock(mutex_);
    pictures_[++last_handle_] = std::move(picture);
    return last_handle_;
  }
  bool erase(std::uint32_t handle) {
    const std::lock_guard lock(mutex_);
    return pictures_.erase(handle) > 0;
  }
  std::optional<StoredPicture> find(std::uint32_t handle) const {
    const std::lock_guard lock(mutex_);
    const auto found = pictures_.find(handle);
    return found == pictures_.end() ? std::nullopt : std::optional(found->second);
  }
  std::vector<std::uint32_t> handles() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> handles;
    for (const auto& [handle, picture] : pictures_) handles.push_back(handle);
    return handles;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::uint32_t, StoredPicture> pictures_;
  std::uint32_t last_handle_ = 0x100;
};

}  // namespace lumitexel::ptp
