// Photographs taken elsewhere become a session (design section 5, "Import layout").
//
// The session holds the sources unchanged: documents cameras.txt, images.txt, lights.csv, mesh.ply or mesh.obj,
// response.csv if a curve was given, and import.json; frames of role "photograph" and "mask".
//
//   import.json  {"version": 1, "channels": 1|3, "mesh": DOCUMENT, "response": "linear"|"srgb"|"response.csv",
//                 "views": [{"image": name in images.txt, "photograph": FRAME, "mask": FRAME or null}]}
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "rig/progress.h"

namespace lumitexel {

struct ImportSources {
  std::filesystem::path colmap;  // directory of cameras.txt and images.txt
  std::filesystem::path images;  // directory of the photographs, by their names in images.txt
  std::filesystem::path lights, mesh;
  std::optional<std::filesystem::path> masks;  // directory: NAME.png for the photograph NAME.exr (or NAME.exr.png)
  std::string
      response;  // linear, srgb or a file (code_response.h); needed for 8- and 16-bit photographs; EXR is linear
};

struct ImportSummary {
  int views = 0, heldout = 0, channels = 0;
};

// Reads and checks everything, then writes the session beside its place and renames it: nothing is left behind by a
// failure. Throws BadInput, naming file and field, for what is missing, malformed or does not fit together: see the
// readers' headers; a photograph of another size than its camera; colour beside grayscale, or EXR beside code values; a
// view without any vertex of the mesh in its frame; `session` in use already. Throws Cancelled on stop, Error or
// StorageFull if the session cannot be written.
ImportSummary import_session(const ImportSources& sources, const std::filesystem::path& session, Progress& progress,
                             std::stop_token stop = {});

}  // namespace lumitexel
