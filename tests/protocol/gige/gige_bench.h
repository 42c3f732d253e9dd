// A small bench with a simulated GigE Vision camera on an address of its own, for tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/aravis/aravis_camera.h"
#include "drivers/aravis/aravis_connection.h"
#include "sim/protocol/gige/gige_camera_server.h"
#include "sim/simulated_bench.h"
#include "sim/state_strip.h"

namespace lumitexel {

CameraLimits small_limits(int bits = 12, Mosaic mosaic = Mosaic::Mono);  // 64 x 48 pixels

// A sensor whose samples are a pattern of place, exposure, gain, turntable and noise key, with the state strip on. Its
// clock runs 20 times faster than ours: exposures are short, and the drivers' deadlines stay honest.
std::shared_ptr<SimulatedBench> pattern_bench(const CameraLimits& sensor);

// On the next free loopback address; no two processes ask for the same ones first.
std::unique_ptr<GigeCameraServer> serve_camera(std::shared_ptr<SimulatedBench> bench, GigeCameraOptions options = {},
                                               std::shared_ptr<FaultSource> faults = std::make_shared<NoFaults>());

// Small packets, so that a frame takes several; frames named; short deadlines.
AravisConnection connection_to(const GigeCameraServer& server);
AravisConnection unnamed_connection_to(const GigeCameraServer& server);

std::unique_ptr<AravisCamera> connect(const AravisConnection& connection, const CameraLimits& limits);

// Records what a camera discards.
std::shared_ptr<std::vector<DiscardedFrame>> record_discards(Camera& camera);

// What the pixels themselves say; fails the test if they say nothing.
StateStrip strip_of(const Frame& frame);

// The samples that the bench has for what the frame's strip says it was taken with.
std::vector<std::uint16_t> expected_samples(SimulatedBench& bench, const Frame& frame);

}  // namespace lumitexel
