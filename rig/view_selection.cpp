#include "rig/view_selection.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Indices = std::set<std::size_t>;

std::string listed(const std::vector<SelectableView>& views) {
  std::string text;
  for (std::size_t i = 0; i < views.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " " + views[i].name + (views[i].heldout ? " (held out)" : "");
  }
  return text;
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string> items_of(std::string_view list) {
  std::vector<std::string> items;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    std::string_view item = list.substr(start, end - start);
    while (item.starts_with(' ')) item.remove_prefix(1);
    while (item.ends_with(' ')) item.remove_suffix(1);
    items.emplace_back(item);
    start = end + 1;
  }
  return items;
}

// Extensions of photographs only: "pose.1" and "pose.2" are two views.
std::string without_extension(const std::string& name) {
  static const std::set<std::string> kPhotographs{".exr", ".png", ".tif", ".tiff", ".pgm", ".dng"};
  const std::filesystem::path path(name);
  return kPhotographs.contains(path.extension().string()) ? path.stem().string() : name;
}

std::optional<std::size_t> find_view(const std::string& option, const std::string& typed, const std::vector<std::string>& names) {
  if (const auto exact = std::find(names.begin(), names.end(), typed); exact != names.end()) return exact - names.begin();
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    // Two extensions that differ are two photographs.
    const bool same = without_extension(names[i]) == typed || names[i] == without_extension(typed);
    if (!same) continue;
    if (found) throw BadInput(option, "'" + typed + "' could be " + names[*found] + " or " + names[i], "a view's whole name");
    found = i;
  }
  return found;
}

// One option's value, taken apart.
class Reader {
 public:
  Reader(const std::string& option, const std::string& value, const std::vector<SelectableView>& views)
      : option_(option), value_(value), views_(views) {}

  void read(Indices& indices, std::set<ShotKind>* kinds) const {
    const std::size_t equals = value_.find('=');
    const std::string key = value_.substr(0, equals);
    const bool of_views = key == "view" || key == "views", of_kinds = kinds != nullptr && key == "kind";
    if (equals == std::string::npos || (!of_views && !of_kinds)) {
      fail("'" + value_ + "'", std::string("view=NAME, view=INDEX or views=FIRST..LAST") +
                                   (kinds != nullptr ? ", or kind=KIND" : ""));
    }
    for (const std::string& item : items_of(std::string_view(value_).substr(equals + 1))) {
      if (of_views) {
        add_views(item, indices);
      } else {
        kinds->insert(kind_of(item));
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw BadInput(option_, what, expected);
  }

  void add_views(const std::string& item, Indices& indices) const {
    std::vector<std::string> names;
    for (const SelectableView& view : views_) names.push_back(view.name);
    if (const auto index = find_view(option_, item, names)) {
      indices.insert(*index);
      return;
    }
    const std::size_t dots = item.find("..");
    const auto first = whole_number(item.substr(0, dots));
    const auto last = dots == std::string::npos ? first : whole_number(item.substr(dots + 2));
    if (!first || !last || *first > *last || *last >= views_.size()) {
      fail("no view '" + item + "'", "one of " + listed(views_));
    }
    for (std::size_t i = *first; i <= *last; ++i) indices.insert(i);
  }

  ShotKind kind_of(const std::string& item) const {
    try {
      return shot_kind_from_string(item);
    } catch (const Corrupt&) {
      fail("no kind '" + item + "'", "silhouette, spheres_ring, spheres_point, object, gray_card, dark, board, flat_field or lamp_pattern");
    }
  }

  const std::string& option_;
  const std::string& value_;
  const std::vector<SelectableView>& views_;
};

}  // namespace

std::size_t view_named(const std::string& option, const std::string& typed, const std::vector<std::string>& names) {
  if (const auto found = find_view(option, typed, names)) return *found;
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw BadInput(option, "no view '" + typed + "'", "one of " + known);
}

ViewSelection select_views(const std::vector<SelectableView>& views, const SelectionOptions& options) {
  ViewSelection selection;
  Indices only, without;
  const std::string only_name = "--only", without_name = "--without";
  for (const std::string& value : options.only) Reader(only_name, value, views).read(only, nullptr);
  for (const std::string& value : options.without) {
    Reader(without_name, value, views).read(without, &selection.kinds_left_out);
  }
  bool any_fit = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool kept = (options.only.empty() || only.contains(i)) && !without.contains(i);
    (kept ? selection.kept : selection.left_out).push_back(views[i].name);
    any_fit = any_fit || (kept && !views[i].heldout);
  }
  if (!any_fit && !views.empty()) {  // a plan for the lens alone has none
    throw BadInput("--without and --only", "no view to fit is left",
                   "at least one that is not held out of " + listed(views));
  }
  return selection;
}

}  // namespace lumitexel
