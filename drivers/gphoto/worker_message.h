// What the driver and its worker process say to each other, over a stream socket. Each message:
//
//   4 bytes  length of the head, little-endian       8 bytes  length of the bytes behind it
//   head     JSON: {"fields": {name: text, …}, "texts": [text, …]}
//   bytes    a file's content, as it is
//
// Requests have a field "verb":
//   open model, port                    connects; answers nothing
//   set name, value                     a setting, by the text of one of its choices or free text
//   get name                            -> value
//   choices name                        -> texts
//   capture timeout_s                   releases the shutter and waits for the file -> folder, file
//   download folder, file               -> bytes
//   remove folder, file                 deletes it from the card
//   close
// An answer with a field "cause" is a failure: "timeout", "disconnected", "protocol", "out_of_range" or "storage_full";
// "text" says more.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lumitexel {

struct WorkerMessage {
  std::map<std::string, std::string> fields;
  std::vector<std::string> texts;
  std::vector<std::uint8_t> bytes;

  // Throws Protocol if there is no such field.
  const std::string& field(const std::string& name) const;
};

inline constexpr std::size_t kMessagePrefixBytes = 12;

// Prefix and head; the bytes follow it as they are.
std::string encoded_head(const WorkerMessage& message);

struct MessageLengths {
  std::size_t head = 0, bytes = 0;
};
// prefix: kMessagePrefixBytes of them. Throws Protocol for lengths that no message has.
MessageLengths lengths_of(const std::uint8_t* prefix);
// Throws Protocol if it is not what encoded_head() makes.
void decode_head(const std::string& head, WorkerMessage& message);

}  // namespace lumitexel
