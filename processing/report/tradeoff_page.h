// What `lumitexel tradeoff` measured, as one page for people: a single HTML file that needs nothing else.
#pragma once

#include <string>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

// session_name: what the page is titled with. json: of tradeoff_json(), carried in the page's data block.
std::string tradeoff_page(const std::string& session_name, const Tradeoff& tradeoff, const std::string& json);

}  // namespace lumitexel
