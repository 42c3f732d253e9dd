// What a conversion costs, as the written files state it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// {"views", "psnr_db" (null for equal pictures: JSON knows no infinity), "relative_rms", "clipped_rms", "sqrt_rms"}
nlohmann::json loss_json(const ConversionLoss& loss);

}  // namespace lumitexel
