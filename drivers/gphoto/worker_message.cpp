#include "drivers/gphoto/worker_message.h"

#include <nlohmann/json.hpp>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::size_t kLongestHead = 1u << 20;
constexpr std::size_t kLargestFile = std::size_t{2} << 30;

void put_number(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::uint64_t number(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
  return value;
}

}  // namespace

const std::string& WorkerMessage::field(const std::string& name) const {
  const auto found = fields.find(name);
  if (found == fields.end()) throw Protocol("camera worker: a message without '" + name + "'");
  return found->second;
}

std::string encoded_head(const WorkerMessage& message) {
  const nlohmann::json json = {{"fields", message.fields}, {"texts", message.texts}};
  // A camera's texts may be no UTF-8; they are for people then.
  const std::string head = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  put_number(out, head.size(), 4);
  put_number(out, message.bytes.size(), 8);
  return out + head;
}

MessageLengths lengths_of(const std::uint8_t* prefix) {
  const MessageLengths lengths{number(prefix, 4), number(prefix + 4, 8)};
  if (lengths.head <= kLongestHead && lengths.bytes <= kLargestFile) return lengths;
  throw Protocol("camera worker: a message of " + std::to_string(lengths.head) + " + " + std::to_string(lengths.bytes) +
                 " bytes");
}

void decode_head(const std::string& head, WorkerMessage& message) {
  try {
    const nlohmann::json json = nlohmann::json::parse(head);
    json.at("fields").get_to(message.fields);
    json.at("texts").get_to(message.texts);
  } catch (const nlohmann::json::exception& error) {
    throw Protocol(std::string("camera worker: a message that cannot be read: ") + error.what());
  }
}

}  // namespace lumitexel
