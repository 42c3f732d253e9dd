// Whether a GigE Vision camera is there at all, found out quickly: the library itself needs 2.5 s to give a camera up, and
// finds it by broadcasting on every interface.
#pragma once

#include <string>

namespace lumitexel {

bool is_ip_address(const std::string& text);

// Asks the camera at this IP address to identify itself, a few times within about a second. Returns the address of ours
// that packets to it leave from. Throws Disconnected naming `camera` if there is no way to it or no answer.
std::string own_address_facing(const std::string& device_address, const std::string& camera);

}  // namespace lumitexel
