// Small models and sessions on disk for commands that take a model.
#pragma once

#include <gtest/gtest.h>

#include <map>

#include "processing/model/model_file.h"
#include "tests/endtoend/run_program.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/small_import.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

// With a layout of its own of 16 x 8 texels, 7 samples in each.
inline std::string written_sphere(const TemporaryFolder& folder) {
  Model model = model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05));
  model.provenance_json = R"({"session_key": "none", "layout": {"from": "mesh"}})";
  write_model(folder / "model", model);
  return (folder / "model").string();
}

// Every file below, hidden ones too, by its path from there, with its bytes.
inline std::map<std::string, std::string> files_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    files[name] = entry.is_regular_file() ? read_whole_file(entry.path()) : "";
  }
  return files;
}

// Before a program's name: no file of its may be longer than so many blocks of the shell's (512 or 1024 bytes), as if the disk were full.
inline std::string disk_of(int blocks) { return "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; "; }

// SmallImport's photographs as a session.
inline std::string imported(const SmallImport& photographs, const std::string& name) {
  const std::string from = photographs.path("").string(), session = photographs.path(name).string();
  const ProgramRun run = run_program("import --colmap " + from + " --images " + from + "images --lights " + from + "lights.csv --mesh " + from +
                                     "mesh.obj --out " + session);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return session;
}

}  // namespace lumitexel
