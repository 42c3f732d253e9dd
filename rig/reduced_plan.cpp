#include "rig/reduced_plan.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "drivers/error.h"
#include "rig/capture_plan.h"

namespace lumitexel {
namespace {

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string plan_with_views(const std::string& plan_toml, const std::vector<std::string>& names,
                            const std::string& where) {
  CapturePlan expected = parse_plan(plan_toml, where);
  std::erase_if(expected.views, [&](const PlannedView& view) { return !among(names, view.name); });

  toml::table table = toml::parse(plan_toml, where);
  toml::array& views = *table["views"].as_array();  // parse_plan saw to that
  for (std::size_t i = views.size(); i-- > 0;) {
    if (!among(names, views[i].as_table()->at("name").value_or(std::string()))) {
      views.erase(views.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  std::ostringstream text;
  text << table << '\n';
  if (parse_plan(text.str(), where) != expected) throw Error(where + ": the plan with fewer views does not read back");
  return text.str();
}

}  // namespace lumitexel
