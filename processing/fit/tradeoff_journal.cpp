#include "processing/fit/tradeoff_journal.h"

#include <algorithm>
#include <utility>

#include "drivers/error.h"
#include "processing/fit/tradeoff_json.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEntries = "tradeoff_measurements";

Json entry_of(const std::string& key, const TradeoffSetting& setting) { return {{"of", key}, {"setting", setting_json(setting)}}; }

Json entries_in(const std::filesystem::path& file) {
  const Json document = Json::parse(read_whole_file(file), nullptr, false);
  const bool ours = document.is_object() && document.contains(kEntries) && document.at(kEntries).is_array();
  const auto is_entry = [](const Json& entry) { return entry.is_object() && entry.contains("of") && entry.contains("setting") && entry.contains("measured"); };
  if (!ours || !std::all_of(document.at(kEntries).begin(), document.at(kEntries).end(), is_entry)) {
    throw BadInput(file.string(), "a file of another kind", "one that an earlier tradeoff --keep wrote, or the name of a new one");
  }
  return document.at(kEntries);
}

}  // namespace

TradeoffJournal::TradeoffJournal(std::filesystem::path file, std::string key) : file_(std::move(file)), key_(std::move(key)) {
  if (std::filesystem::exists(file_)) entries_ = entries_in(file_);
  write();  // at once: hours later would be late to learn that it cannot be
}

void TradeoffJournal::write() const { write_whole_file(file_, Json{{kEntries, entries_}}.dump(1) + "\n"); }

std::optional<TradeoffRun> TradeoffJournal::known(const TradeoffSetting& setting) const {
  const Json wanted = entry_of(key_, setting);
  for (const Json& entry : entries_) {
    if (entry.at("of") != wanted.at("of") || entry.at("setting") != wanted.at("setting")) continue;
    try {
      return run_from(entry.at("measured"));
    } catch (const Json::exception& error) {
      throw BadInput(file_.string(), error.what(), "measurements as tradeoff --keep writes them, or the name of a new file");
    }
  }
  return std::nullopt;
}

void TradeoffJournal::keep(const TradeoffSetting& setting, const TradeoffRun& run) {
  if (!run.measured()) return;
  Json entry = entry_of(key_, setting);
  entry["measured"] = run_json(run);
  entries_.push_back(std::move(entry));
  write();
}

}  // namespace lumitexel
