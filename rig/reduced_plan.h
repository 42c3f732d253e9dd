// A capture plan with fewer views.
#pragma once

#include <string>
#include <vector>

namespace lumitexel {

// The plan as TOML with the views of these names only, in the plan's order; everything else as it was, to the last
// bit of every number (comments are lost). Throws BadInput if `plan_toml` is no plan or no view to fit is left, Error
// if the result would not read back as just that.
std::string plan_with_views(const std::string& plan_toml, const std::vector<std::string>& names,
                            const std::string& where);

}  // namespace lumitexel
