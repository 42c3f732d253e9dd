#include "processing/fit/coarser_session.h"

#include <stdlib.h>

#include <algorithm>

#include "drivers/error.h"
#include "processing/calibration/lens/larger_pixels.h"
#include "processing/image/binned_radiance.h"

namespace lumitexel {
namespace {

std::shared_ptr<const std::filesystem::path> temporary_folder() {
  std::error_code none;
  std::string pattern = (std::filesystem::temp_directory_path(none) / "lumitexel-coarser-XXXXXX").string();
  if (none || mkdtemp(pattern.data()) == nullptr) throw Error("no temporary folder can be made as " + pattern + "; is there room, and is TMPDIR right?");
  return {new std::filesystem::path(pattern), [](const std::filesystem::path* folder) {
            std::error_code ignored;
            std::filesystem::remove_all(*folder, ignored);
            delete folder;
          }};
}

}  // namespace

CoarserSession::CoarserSession(const CalibratedSession& session, int block) : session_(session) {
  if (block == 1) return;
  folder_ = temporary_folder();
  std::size_t number = 0;
  for (View& view : session_.views) {
    if (view.heldout) continue;
    if (std::min(view.camera.width_px, view.camera.height_px) < block) throw Error(view.name + " is smaller than a block of " + std::to_string(block) + " pixels");
    const std::filesystem::path coarser = *folder_ / (std::to_string(number++) + ".exr");
    write_radiance_image(coarser, binned(read_radiance_image(view.photograph), block));
    view.photograph = coarser;
    view.camera = with_larger_pixels(view.camera, block);
  }
}

}  // namespace lumitexel
