// How long after a trip of the safety lane the controllers have switched their lamps off and stopped their axes, by
// their own records, over Modbus TCP and RTU: with every core busy, the session's writer frozen and the devices' lines
// in use. Beside it what a bare pseudo-terminal takes at the same time, since RTU goes over one here. Not a test.
//
//   build/release/tests/bench/safety_latency [TRIPS]
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "drivers/clock.h"
#include "drivers/error.h"
#include "tests/bench/bare_terminal.h"
#include "tests/bench/machine.h"
#include "tests/protocol/session/frozen_capture.h"

namespace lumitexel {
namespace {

constexpr double kGoal_ms = 100.0;

// One thread a core that computes and touches memory without a pause.
class BusyCores {
 public:
  BusyCores() {
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([](std::stop_token stop) {
        std::vector<double> image(1 << 20, 1.0);
        for (std::size_t at = 0; !stop.stop_requested(); at = (at + 1) % image.size()) {
          image[at] = std::sqrt(image[at] + 2.0);
        }
        volatile double used = image.front();
        (void)used;
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

double percentile(const std::vector<double>& sorted, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

double print_latencies(const char* name, std::vector<double> all_ms) {
  std::sort(all_ms.begin(), all_ms.end());
  const double worst_but_few = percentile(all_ms, 0.999);
  std::printf("%-22s median %.2f ms, 99 %% %.2f ms, 99.9 %% %.2f ms, maximum %.2f ms\n", name, percentile(all_ms, 0.5),
              percentile(all_ms, 0.99), worst_but_few, all_ms.back());
  return worst_but_few;
}

int run(int trips) {
  std::printf("%s\n%d trips, every core busy, the writer frozen, both lines in use\n", machine_line().c_str(), trips);
  FrozenCapture capture;
  const BusyCores busy;
  BareTerminal bare;
  std::vector<double> table_ms, arm_ms, bare_ms;
  for (int i = 0; i < trips; ++i) {
    const TripLatency latency = capture.trip();
    table_ms.push_back(latency.table_ms);
    arm_ms.push_back(latency.arm_ms);
    bare_ms.push_back(bare.round_trip_ms());
  }
  const double table = print_latencies("Modbus TCP (table)", table_ms);
  const double arm = print_latencies("Modbus RTU (arm)", arm_ms);
  print_latencies("bare terminal, no RTU", bare_ms);
  const auto said = [](double latency_ms) { return latency_ms <= kGoal_ms ? "reached" : "MISSED"; };
  std::printf("goal, 99.9 %% within %.0f ms: TCP %s, RTU %s\n", kGoal_ms, said(table), said(arm));
  return std::max(table, arm) <= kGoal_ms ? 0 : 1;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  try {
    return lumitexel::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 2000);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "safety_latency: %s\n", error.what());
    return 1;
  }
}
