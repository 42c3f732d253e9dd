#include "drivers/aravis/aravis_handle.h"

#include "drivers/error.h"

namespace lumitexel {

void GErrorSlot::require(const std::string& camera, const std::string& asked) const {
  if (error_ == nullptr) return;
  const std::string text = camera + ": " + asked + ": " + error_->message;
  if (error_->domain == ARV_GC_ERROR && error_->code == ARV_GC_ERROR_OUT_OF_RANGE) throw OutOfRange(text);
  if (error_->domain != ARV_DEVICE_ERROR) throw Protocol(text);
  switch (error_->code) {
    case ARV_DEVICE_ERROR_TIMEOUT: throw Timeout(text);
    case ARV_DEVICE_ERROR_NOT_CONNECTED:
    case ARV_DEVICE_ERROR_NOT_FOUND: throw Disconnected(text + "; is it on and cabled?");
    case ARV_DEVICE_ERROR_TRANSFER_ERROR: throw Disconnected(text);
    case ARV_DEVICE_ERROR_NOT_CONTROLLER:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
      throw Disconnected(text + "; the control of it is lost, another program may have it");
    default: throw Protocol(text);
  }
}

}  // namespace lumitexel
