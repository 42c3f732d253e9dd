// Bytes as text (RFC 4648, with padding): how pages carry pictures and data within themselves.
#pragma once

#include <string>

namespace lumitexel {

std::string base64(const std::string& bytes);

}  // namespace lumitexel
