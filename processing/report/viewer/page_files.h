// The files of page/ and three.js, as they were when the program was built; a null name ends the list.
#pragma once

namespace lumitexel {

struct PageFile {
  const char* name;
  const char* text;
};
extern const PageFile kPageFiles[];

}  // namespace lumitexel
