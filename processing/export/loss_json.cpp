#include "processing/export/loss_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lumitexel {

nlohmann::json loss_json(const ConversionLoss& loss) {
  using nlohmann::json;
  const json psnr = std::isfinite(loss.error.psnr_db) ? json(loss.error.psnr_db) : json();
  return {{"views", loss.views}, {"psnr_db", psnr}, {"relative_rms", loss.error.relative_rms},
          {"clipped_rms", loss.error.clipped_rms}, {"sqrt_rms", loss.error.sqrt_rms}};
}

}  // namespace lumitexel
