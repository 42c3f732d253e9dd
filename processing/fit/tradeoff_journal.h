// Fits of a tradeoff kept in a file as they come, so that a run that was stopped goes on where it was.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "processing/fit/tradeoff_run.h"

namespace lumitexel {

class TradeoffJournal {
 public:
  // key: of session, program and machine, whose measurements these are; those of others stay in the file and are not looked at. A file that is
  // not there becomes an empty journal. Throws BadInput if it holds something else, Error where it cannot be written. One run at a time.
  TradeoffJournal(std::filesystem::path file, std::string key);

  std::optional<TradeoffRun> known(const TradeoffSetting& setting) const;
  void keep(const TradeoffSetting& setting, const TradeoffRun& run);  // measured ones only; throws Error where the file cannot be written

 private:
  std::filesystem::path file_;
  std::string key_;
  void write() const;
  nlohmann::ordered_json entries_ = nlohmann::ordered_json::array();
};

}  // namespace lumitexel
