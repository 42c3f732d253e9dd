// Model::outliers_csv read back.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "processing/fit/outliers.h"

namespace lumitexel {

// By the view's name and the atlas index of the texel. Throws Corrupt on a line that outliers_csv does not write.
std::map<std::pair<std::string, std::uint32_t>, OutlierReason> listed_outliers(const std::string& csv, int atlas_width);

}  // namespace lumitexel
