#include "sim/protocol/ptp/operations.h"

#include <memory>
#include <optional>
#include <utility>

#include "sim/protocol/ptp/dataset.h"

namespace lumitexel::ptp {
namespace {

Reply only(Response code) { return {code, {}, nullptr}; }

Reply with_data(std::vector<std::uint8_t> data) {
  return {Response::Ok, {}, std::make_shared<const std::vector<std::uint8_t>>(std::move(data))};
}

Reply with_property(std::optional<std::vector<std::uint8_t>> data) {
  return data ? with_data(std::move(*data)) : only(Response::DevicePropNotSupported);
}

}  // namespace

Reply Operations::answer(const Request& request, std::uint64_t session, Fault fault) {
  if (request.operation == Operation::GetDeviceInfo) return device_info();
  if (request.operation == Operation::OpenSession) {
    const bool was_open = std::exchange(open_, true);
    return only(was_open ? Response::SessionAlreadyOpen : Response::Ok);
  }
  return open_ ? in_session(request, session, fault) : only(Response::SessionNotOpen);
}

Reply Operations::in_session(const Request& request, std::uint64_t session, Fault fault) {
  const std::uint32_t first = request.parameters[0];
  const auto code = static_cast<std::uint16_t>(first);
  switch (request.operation) {
    case Operation::CloseSession:
      open_ = false;
      return only(Response::Ok);
    case Operation::GetStorageIds:
      return with_data(DatasetWriter().numbers32({kStorageId}).take());
    case Operation::GetStorageInfo:
      return storage_info();
    case Operation::GetNumObjects:
      return {Response::Ok, {static_cast<std::uint32_t>(card_.handles().size())}, nullptr};
    case Operation::GetObjectHandles: {
      // The card's files lie in its root; there are no folders to look into.
      const bool root = request.parameters[2] == 0 || request.parameters[2] == 0xFFFFFFFF;
      return with_data(DatasetWriter().numbers32(root ? card_.handles() : std::vector<std::uint32_t>{}).take());
    }
    case Operation::GetObjectInfo:
      return object_info(first);
    case Operation::GetObject:
      return object(first);
    case Operation::DeleteObject:
      return only(card_.erase(first) ? Response::Ok : Response::InvalidObjectHandle);
    case Operation::InitiateCapture:
      return capture(request, session, fault);
    case Operation::GetDevicePropDesc:
      return with_property(properties_.description(code));
    case Operation::GetDevicePropValue:
      return with_property(properties_.value(code));
    case Operation::SetDevicePropValue:
      return only(properties_.set(code, request.data));
    default:
      return only(Response::OperationNotSupported);
  }
}

Reply Operations::device_info() const {
  DatasetWriter writer;
  writer.u16(100).u32(0).u16(100).text("").u16(0);  // standard 1.00, no vendor's extension, standard mode
  writer.numbers16(
      {0x1001, 0x1002, 0x1003, 0x1004, 0x1005, 0x1006, 0x1007, 0x1008, 0x1009, 0x100B, 0x100E, 0x1014, 0x1015, 0x1016});
  writer.numbers16({0x4002, 0x400D});
  writer.numbers16(properties_.codes());
  writer.numbers16({kFormatDng}).numbers16({kFormatDng});
  writer.text(identity_.make).text(identity_.model).text("1.0").text(identity_.serial);
  return with_data(writer.take());
}

Reply Operations::storage_info() const {
  DatasetWriter writer;
  writer.u16(4).u16(2).u16(0);  // removable RAM, hierarchical, read and write
  writer.u64(std::uint64_t{64} << 30).u64(std::uint64_t{32} << 30).u32(10'000).text("card").text("");
  return with_data(writer.take());
}

Reply Operations::object_info(std::uint32_t handle) const {
  const std::optional<StoredPicture> picture = card_.find(handle);
  if (!picture) return only(Response::InvalidObjectHandle);
  DatasetWriter writer;
  writer.u32(kStorageId).u16(kFormatDng).u16(0).u32(picture->file->size());
  writer.u16(0).u32(0).u32(0).u32(0);  // no thumbnail
  writer.u32(static_cast<std::uint32_t>(picture->width_px)).u32(static_cast<std::uint32_t>(picture->height_px)).u32(16);
  writer.u32(0).u16(0).u32(0).u32(0);  // in no folder
  writer.text(picture->name).text("").text("").text("");
  return with_data(writer.take());
}

Reply Operations::object(std::uint32_t handle) const {
  const std::optional<StoredPicture> picture = card_.find(handle);
  if (!picture) return only(Response::InvalidObjectHandle);
  return {Response::Ok, {}, picture->file};
}

Reply Operations::capture(const Request& request, std::uint64_t session, Fault fault) {
  Release release;
  release.settings = properties_.settings();
  release.iso = static_cast<int>(properties_.number(Property::ExposureIndex));
  release.f_number = properties_.number(Property::FNumber) / 100.0;
  release.artist = properties_.text(Property::Artist);
  release.fault = fault;
  release.session = session;
  release.transaction = request.transaction;
  return only(shutter_.release(release) ? Response::Ok : Response::DeviceBusy);
}

}  // namespace lumitexel::ptp
