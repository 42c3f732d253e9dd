#include <memory>

#include "processing/calibration/import/reduced_import.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/replay_result.h"
#include "rig/replay_session.h"

namespace lumitexel {
namespace {

struct ReplayOptions {
  std::string session, out;
  SelectionOptions selection;
};

// No rig took an imported session: its files are copied.
CommandResult copy_imported(const SessionStore& session, const ReplayOptions& options, CommandContext& context) {
  const ViewSelection selection = select_views(imported_views(session), options.selection);
  const std::int64_t frames = copy_import(session, selection, options.out, context.progress, context.stop);
  CommandResult result;
  result.json = {{"session", options.out}, {"frames", frames}, {"left_out", selection.left_out}, {"missing", 0}};
  result.text = options.out + ": " + std::to_string(selection.kept.size()) + " views, " +
                std::to_string(selection.left_out.size()) + " left out, " + std::to_string(frames) + " files copied\n";
  return result;
}

CommandResult run(const ReplayOptions& options, CommandContext& context) {
  SessionStore::require_new_directory(options.out);
  const auto recording =
      std::make_shared<const SessionStore>(session_given("SESSION", options.session));
  if (recording->kind() == SessionKind::Imported) return copy_imported(*recording, options, context);
  const ViewSelection selection = select_views(planned_views(*recording), options.selection);
  SessionStore replay = begin_replay(*recording, selection, options.out);
  const ReplaySummary summary = play_missing_shots(recording, replay, context.progress, context.stop);
  return replay_result(*recording, replay, summary);
}

}  // namespace

void add_replay_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<ReplayOptions>();
  Command command(app, "replay", "Play a recorded session back into a new one, all of it or with views left out");
  command.add_option("SESSION", options->session, "The recorded session's folder").required();
  command.add_option("--out", options->out, "The new session's folder: empty or not there yet").required();
  command.add_option("--without", options->selection.without,
                     "What to leave out: view=NAME, view=INDEX (from 0 in the plan's order), views=FIRST..LAST, "
                     "several by commas (views=0..2,heldout_000), or kind=dark and other kinds of shot; may be given again")
      .one_each_time();
  command.add_option("--only", options->selection.only,
                     "Which views to keep, in the same words; may be given again. Gray card and darks always stay")
      .one_each_time();
  command.callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
