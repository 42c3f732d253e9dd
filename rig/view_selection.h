// Which of a session's views a shorter session keeps: `--without view=7 --only views=0..14`.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "rig/shot.h"

namespace lumitexel {

struct SelectableView {
  std::string name;
  bool heldout = false;
};

// As typed, each KEY=ITEM[,ITEM…]. Keys are view and views, for `without` also kind. An item is a view's name (as view_named takes it), its index from 0 in the session's order, a range FIRST..LAST of indices, both included,
// or a shot kind. A name goes before an index.
struct SelectionOptions {
  std::vector<std::string> without, only;
};

struct ViewSelection {
  std::vector<std::string> kept, left_out;  // views, in the session's order
  std::set<ShotKind> kinds_left_out;
  bool everything() const { return left_out.empty() && kinds_left_out.empty(); }
};

// The index of the view that `typed` names; an extension may be left out, or stand there although the view's name has none. An exact name
// goes first. Throws BadInput naming the option and what there is if no view or more than one is meant.
std::size_t view_named(const std::string& option, const std::string& typed, const std::vector<std::string>& names);

// Keeps what any `only` names (all views without one), less what any `without` names. Throws BadInput naming the option
// and what there is: for a view or kind that does not exist, for anything unreadable, and if no view to fit is left.
ViewSelection select_views(const std::vector<SelectableView>& views, const SelectionOptions& options);

}  // namespace lumitexel
