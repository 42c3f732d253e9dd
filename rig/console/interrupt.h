// Ctrl-C: as a stop token for commands that end cleanly by themselves when asked, and with a word for the others.
#pragma once

#include <stop_token>

namespace lumitexel {

// From now on the first SIGINT, SIGTERM, SIGHUP or SIGQUIT requests a stop, from a thread of its own; a second one ends the
// program after a second and a half, in which lamps go off. Output that nobody reads any more ends nothing. Call
// before any other thread starts. Without this call both signals end the program as usual.
std::stop_token stop_on_interrupt();

// SIGINT and SIGTERM end the program as usual, after a line on stderr that says so.
void end_on_interrupt();

}  // namespace lumitexel
