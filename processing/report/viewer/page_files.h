// The files of page/ and three.js, as they were when the program was built; a null name ends the list.
#pragma once

#include <string>

namespace lumitexel {

struct PageFile {
  const char* name;
  const char* text;
};
extern const PageFile kPageFiles[];

std::string page_file(const std::string& name);  // throws Error if there is none

}  // namespace lumitexel
