// One photograph taken elsewhere, as linear radiance: EXR as it is, 8- or 16-bit PNG or TIFF through a response.
#pragma once

#include <filesystem>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/import/code_response.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {

// By the file's extension, in either case.
bool is_exr_name(const std::filesystem::path& path);

// Variance 0 (unknown). Flags: kPixelSaturated where any code value is the largest (PNG, TIFF); an EXR has none.
// `response` is not used for EXR. Throws BadInput naming the file if it cannot be decoded, holds a value that is not
// finite, or is black all over.
RadianceImage read_photograph(const std::filesystem::path& path, const CodeResponse& response);

// Adds kPixelOutside wherever a mask (8 bits, one channel or all alike) is not 255, exactly as given. Throws BadInput
// naming the mask if it cannot be decoded, has another size than the photograph, or has no pixel of 255.
void apply_mask(const std::filesystem::path& mask, RadianceImage& photograph);

}  // namespace lumitexel
