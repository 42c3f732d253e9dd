// Many shots over the protocols of several rigs at once, with random faults of every kind, and what became of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/protocol/session/protocol_rig.h"
#include "tests/protocol/session/session_checker.h"

namespace lumitexel {

struct CampaignOptions {
  int shots = 10000;
  int gige_rigs = 6;       // their cameras' settings land 0, 1, … 5 frames late, and packets get lost at 1 to 5 %
  int still_rigs = 2;      // by PTP/IP: slow, so they take a small part of the shots
  int still_shots = 400;
  std::uint64_t seed = 1;
  double fault_scale = 1.0;  // of all probabilities
  std::filesystem::path folder;  // sessions are made in here
};

struct CampaignResult {
  SessionCheck check;                           // of all rigs together
  // By fault, then "camera (GigE)", "camera (still)", "controller".
  std::map<std::string, std::map<std::string, int>> injected;
  std::map<std::string, int> discards;          // by cause
  std::map<std::string, int> pauses;            // "device: cause"
  std::map<std::string, std::uint64_t> operations;  // by device as above
  int connections = 0, incomplete_sessions = 0;
  int unnamed_pauses = 0;     // that name no device
  int unsafe_pauses = 0;      // with a lamp lit or an axis moving, and nothing said of it
  int told_unsafe_pauses = 0;  // that say which controller has not acknowledged lamps off and axes stopped
  std::uint64_t exposures = 0;
  double seconds = 0.0;
  std::vector<std::string> remarkable;          // messages of pauses that should not be
  int mislabelled = 0, lost = 0, duplicated = 0;
};

// told: of how many exposures there are so far, every few seconds.
CampaignResult run_campaign(const CampaignOptions& options, const std::function<void(std::uint64_t)>& told);

}  // namespace lumitexel
