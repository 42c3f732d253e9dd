// 10,000 shots over the protocols of simulated rigs with random faults of every kind: how many frames were mislabelled,
// lost or duplicated. Not a test; takes minutes.
//
//   build/release/tests/bench/fault_campaign [--shots N] [--seed S] [--json] [--keep DIR]
//   build/release/tests/bench/fault_campaign --matrix [--step K]     every single fault at every K-th operation instead
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "tests/bench/campaign.h"
#include "tests/bench/machine.h"
#include "tests/protocol/session/single_faults.h"

namespace lumitexel {
namespace {

void print_counts(const char* title, const std::map<std::string, int>& counts) {
  std::printf("%s\n", title);
  for (const auto& [name, count] : counts) std::printf("  %6d  %s\n", count, name.c_str());
}

void print_table(const CampaignResult& result) {
  std::printf("%s\n", machine_line().c_str());
  std::printf("shots %ld, frames %ld, exposures %lu, %.0f s\n", static_cast<long>(result.check.shots),
              static_cast<long>(result.check.frames), static_cast<unsigned long>(result.exposures), result.seconds);
  int all = 0;
  std::printf("faults injected\n");
  for (const auto& [fault, places] : result.injected) {
    int sum = 0;
    std::string where;
    for (const auto& [place, count] : places) {
      sum += count;
      where += (where.empty() ? "" : ", ") + place + " " + std::to_string(count);
    }
    all += sum;
    std::printf("  %6d  %-16s %s\n", sum, fault.c_str(), where.c_str());
  }
  std::printf("  %6d  in all\n", all);
  for (const auto& [device, count] : result.operations) {
    std::printf("operations of %s: %lu\n", device.c_str(), static_cast<unsigned long>(count));
  }
  print_counts("discarded attempts by cause", result.discards);
  print_counts("safe pauses by device and cause", result.pauses);
  std::printf("connections %d; sessions given up %d; pauses not at rest without a word %d, that say NOT SAFE %d, that "
              "name no device %d\n",
              result.connections, result.incomplete_sessions, result.unsafe_pauses, result.told_unsafe_pauses,
              result.unnamed_pauses);
  for (const std::string& message : result.remarkable) std::printf("  remarkable: %s\n", message.c_str());
  std::printf("mislabelled %d, lost %d, duplicated %d\n%s", result.mislabelled, result.lost, result.duplicated,
              result.check.text().c_str());
}

nlohmann::json json_of(const CampaignResult& result) {
  return {{"date_utc", utc_date()},           {"cpu", cpu_name()},
          {"shots", result.check.shots},      {"frames", result.check.frames},
          {"exposures", result.exposures},    {"seconds", result.seconds},
          {"injected", result.injected},      {"operations", result.operations},
          {"discards", result.discards},      {"pauses", result.pauses},
          {"connections", result.connections}, {"unsafe_pauses", result.unsafe_pauses},
          {"told_unsafe_pauses", result.told_unsafe_pauses},
          {"unnamed_pauses", result.unnamed_pauses}, {"incomplete_sessions", result.incomplete_sessions},
          {"mislabelled", result.mislabelled}, {"lost", result.lost},
          {"duplicated", result.duplicated}};
}

bool is_clean(const CampaignResult& result) {
  return result.mislabelled + result.lost + result.duplicated + result.unsafe_pauses + result.unnamed_pauses +
             result.incomplete_sessions == 0;
}

int run_matrix(CameraKind camera, std::uint64_t step, int threads) {
  if (camera == CameraKind::Still) offer_only_the_ptp_driver();
  const std::vector<SingleFault> all = fault_matrix(camera, count_operations(camera), step);
  std::fprintf(stderr, "%zu cases\n", all.size());
  int wrong = 0, happened = 0, paused = 0;
  double longest_s = 0.0;
  for (const SingleFaultOutcome& outcome : suffer_all(all, threads)) {
    happened += outcome.happened ? 1 : 0;
    paused += outcome.pauses > 0 ? 1 : 0;
    longest_s = std::max(longest_s, outcome.seconds);
    if (outcome.objection.empty()) continue;
    ++wrong;
    std::printf("%s: %s\n", outcome.what.text().c_str(), outcome.objection.c_str());
  }
  std::printf("%s\n%zu cases, %d of which happened, %d with safe pauses, longest %.1f s, wrong %d\n",
              machine_line().c_str(), all.size(), happened, paused, longest_s, wrong);
  return wrong == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  CampaignOptions options;
  std::string keep;
  bool json = false, matrix = false, still = false;
  std::uint64_t step = 1;
  int threads = 16;
  CLI::App app("Random faults over the protocols of simulated rigs: frames mislabelled, lost, duplicated");
  app.add_option("--shots", options.shots, "In all")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--gige-rigs", options.gige_rigs, "Side by side")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--still-rigs", options.still_rigs, "Side by side")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--still-shots", options.still_shots, "Of all shots, those by PTP/IP")->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--fault-scale", options.fault_scale, "Of all probabilities")->capture_default_str();
  app.add_option("--keep", keep, "Leave the sessions in this folder");
  app.add_flag("--json", json, "The result on stdout as JSON");
  app.add_flag("--matrix", matrix, "Every single fault at every operation of a short session instead");
  app.add_flag("--still", still, "Of the matrix: with the still camera");
  app.add_option("--step", step, "Of the matrix: every so many operations")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", threads, "Of the matrix: cases side by side")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (matrix) return run_matrix(still ? CameraKind::Still : CameraKind::Gige, step, threads);
  const TemporaryFolder temporary;
  options.folder = keep.empty() ? temporary.path() : std::filesystem::path(keep);
  std::filesystem::create_directories(options.folder);
  const CampaignResult result = run_campaign(options, [](std::uint64_t exposures) {
    std::fprintf(stderr, "%lu exposures\n", static_cast<unsigned long>(exposures));
  });
  if (json) std::cout << json_of(result).dump(2) << '\n';
  else print_table(result);
  return is_clean(result) ? 0 : 1;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  try {
    return lumitexel::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fault_campaign: %s\n", error.what());
    return 1;
  }
}
