// The link's own promises: deadlines, late replies, reconnecting, exceptions.
#include "drivers/modbus/modbus_link.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <thread>

#include "drivers/error.h"
#include "modbus_bench.h"
#include "sim/protocol/modbus/file_descriptor.h"

namespace lumitexel {
namespace {

class Link : public testing::TestWithParam<Transport> {};
INSTANTIATE_TEST_SUITE_P(Over, Link, testing::Values(Transport::Tcp, Transport::Rtu),
                         [](const auto& it) { return std::string(to_string(it.param)); });

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Two registers of the same kind and size, whose replies look the same: the worst case for a late one. Returns how
// often replies were late for so long that the reading failed; on a busy machine the client may be late, too.
int expect_no_late_reply_taken(const ModbusServerSettings& settings) {
  ModbusServerSettings given = settings;
  given.endpoint.give_up_s = 0.1;
  const ModbusBench bench(given);
  bench.bench->start_move(BenchAxis::LightAzimuth, -33.5);
  bench.bench->start_move(BenchAxis::Turntable, 53.3);
  bench.bench_clock->sleep_until(bench.bench_clock->now_s() + 10.0, {});
  const ModbusRegister table = given.axes.at(BenchAxis::Turntable).position;
  const ModbusRegister azimuth = given.axes.at(BenchAxis::LightAzimuth).position;
  int failed = 0;
  for (int i = 0; i < 2; ++i) {
    bench.faults->arm_all(Fault::LateReply);
    try {
      EXPECT_EQ(bench.link->read(azimuth, "azimuth position"), -33.5);
    } catch (const Disconnected&) {
      ++failed;
    }
    bench.faults->disarm();
    // The line may still be busy with replies that are late: then it says so, and never another register's value.
    for (int tries = 0; tries < 10; ++tries) {
      try {
        EXPECT_EQ(bench.link->read(table, "turntable position"), 53.3);
        EXPECT_EQ(bench.link->read(azimuth, "azimuth position"), -33.5);
        break;
      } catch (const Disconnected&) {
        EXPECT_LT(tries, 9);
      }
    }
  }
  return failed;
}

TEST_P(Link, ALateReplyNeverAnswersALaterRequest) {
  int failed = 0;
  for (const double late_by_s : {0.025, 0.035, 0.075}) {
    SCOPED_TRACE(late_by_s);
    ModbusServerSettings settings = quick_settings(GetParam());
    settings.late_by_s = late_by_s;
    failed += expect_no_late_reply_taken(settings);
  }
  EXPECT_GT(failed, 0);
}

// Without the echo that brings a serial line back in step this holds for replies that are not later than two silences.
TEST_P(Link, ALateReplyOfAControllerWithoutDiagnosticsAnswersNoLaterRequest) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.knows_diagnostics = false;
  settings.late_by_s = 0.03;
  expect_no_late_reply_taken(settings);
}

TEST_P(Link, AControllerThatIsRestartedIsFoundAgain) {
  ModbusBench bench(GetParam());
  const ModbusRegister position = bench.settings.axes.at(BenchAxis::Turntable).position;
  EXPECT_EQ(bench.link->read(position, "turntable position"), 0.0);
  bench.restart_server();
  EXPECT_EQ(bench.link->read(position, "turntable position"), 0.0);
  bench.server.reset();
  std::jthread later([&] {
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.3, {});
    bench.restart_server();
  });
  EXPECT_GT(seconds_of([&] { EXPECT_EQ(bench.link->read(position, "turntable position"), 0.0); }), 0.2);
  EXPECT_EQ(bench.link->state(), LinkState::Connected);
}

TEST_P(Link, AControllerThatIsGoneIsDisconnectedInTimeAndMayComeBack) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.endpoint.give_up_s = 0.3;
  ModbusBench bench(settings);
  const ModbusRegister position = settings.axes.at(BenchAxis::Turntable).position;
  bench.server.reset();
  double took_s = 0.0;
  const std::string message = message_of([&] {
    took_s = seconds_of([&] { EXPECT_THROW(bench.link->read(position, "turntable position"), Disconnected); });
    bench.link->read(position, "turntable position");
  });
  EXPECT_GT(took_s, 0.1);
  EXPECT_LT(took_s, 1.0);
  const std::string where = GetParam() == Transport::Tcp ? "127.0.0.1:" + std::to_string(bench.settings.endpoint.port)
                                                         : bench.settings.endpoint.serial_device;
  for (const std::string& part : {std::string("controller bench: reading turntable position (input registers 0-1)"),
                                  std::string("gave up after 0.3 s"), where}) {
    EXPECT_TRUE(holds(message, part)) << message;
  }
  EXPECT_EQ(bench.link->state(), LinkState::Lost);
  EXPECT_THROW(bench.new_link(), Disconnected);
  bench.restart_server();
  EXPECT_EQ(bench.link->read(position, "turntable position"), 0.0);
}

TEST_P(Link, WhatIsNotInTheControllerIsSaidAtOnce) {
  const ModbusBench bench(GetParam());
  for (const RegisterTable table :
       {RegisterTable::Coil, RegisterTable::DiscreteInput, RegisterTable::Holding, RegisterTable::Input}) {
    const ModbusRegister nowhere{table, 4711, RegisterType::Uint16};
    double took_s = 0.0;
    const std::string message = message_of([&] {
      took_s = seconds_of([&] { EXPECT_THROW(bench.link->read(nowhere, "point light fault"), Protocol); });
      bench.link->read(nowhere, "point light fault");
    });
    EXPECT_TRUE(holds(message,
                      "controller bench: reading point light fault (" + to_string(nowhere) + "): Illegal data address"))
        << message;
    EXPECT_LT(took_s, 0.5);
  }
  // Half of a 32-bit value, and a command that the control word does not know.
  EXPECT_THROW(bench.link->write({RegisterTable::Holding, 0}, 1.0, "x"), Protocol);
  EXPECT_THROW(bench.link->write({RegisterTable::Holding, 10}, 3.0, "x"), Protocol);
}

TEST_P(Link, AStopTokenEndsTheRetries) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.endpoint.give_up_s = 30.0;
  ModbusBench bench(settings);
  bench.server.reset();
  std::stop_source stop;
  std::jthread later([&] {
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.2, {});
    stop.request_stop();
  });
  const auto read = [&] { bench.link->read({RegisterTable::Input, 0}, "x", stop.get_token()); };
  EXPECT_LT(seconds_of([&] { EXPECT_THROW(read(), Cancelled); }), 1.5);
}

TEST_P(Link, ThreadsShareALinkWithoutMixingTheirReplies) {
  const ModbusBench bench(GetParam());
  bench.bench->start_move(BenchAxis::Turntable, 53.3);
  bench.bench->start_move(BenchAxis::LightAzimuth, -33.5);
  bench.bench_clock->sleep_until(bench.bench_clock->now_s() + 10.0, {});
  std::atomic<int> wrong = 0;
  const auto read = [&](BenchAxis axis, double expected) {
    for (int i = 0; i < 100; ++i) {
      wrong += bench.link->read(bench.settings.axes.at(axis).position, "position") == expected ? 0 : 1;
    }
  };
  {
    const std::jthread one([&] { read(BenchAxis::Turntable, 53.3); }),
        other([&] { read(BenchAxis::LightAzimuth, -33.5); });
  }
  EXPECT_EQ(wrong, 0);
}

TEST(TcpLink, ConnectingToAnAddressThatDoesNotAnswerHasADeadline) {
  // A listener whose queue is full drops what comes: to a client, a machine that is not there.
  FileDescriptor listener(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(listener.get(), generic, size), 0);
  ASSERT_EQ(listen(listener.get(), 0), 0);
  ASSERT_EQ(getsockname(listener.get(), generic, &size), 0);
  std::vector<FileDescriptor> filling;
  for (int i = 0; i < 3; ++i) {
    filling.emplace_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    connect(filling.back().get(), generic, size);
  }
  ModbusEndpoint endpoint;
  endpoint.name = "far away";
  endpoint.host = "127.0.0.1";
  endpoint.port = ntohs(address.sin_port);
  endpoint.response_timeout_s = 0.1;
  endpoint.give_up_s = 0.3;
  std::string message;
  const double took_s = seconds_of(
      [&] { message = message_of([&] { ModbusLink link(endpoint, std::make_shared<SystemClock>()); }); });
  EXPECT_TRUE(holds(message, "controller far away: connecting: cannot connect: no answer within 0.1 s")) << message;
  EXPECT_LT(took_s, 0.5);  // what the library would wait by itself
}

TEST(TcpLink, AConnectionThatIsAcceptedAndDroppedOrNeverAnsweredIsTriedAgain) {
  for (const Fault fault : {Fault::Disconnect, Fault::Mute}) {
    const ModbusBench bench(Transport::Tcp);
    bench.faults->arm_one(fault, 0);
    const auto second = bench.new_link();
    EXPECT_EQ(second->read(bench.settings.axes.at(BenchAxis::Turntable).position, "turntable position"), 0.0);
    ASSERT_EQ(bench.faults->injected().size(), 1u);
    EXPECT_EQ(bench.faults->injected()[0].operation, "accept");
  }
}

TEST(RtuLink, APortWithoutANameIsMadeInTheFolderForTemporaryFilesAndRemoved) {
  std::filesystem::path port;
  {
    const ModbusBench bench(Transport::Rtu);
    ModbusServerSettings settings = quick_settings(Transport::Rtu);
    const ModbusControllerServer server(settings, bench.bench, bench.faults);
    port = server.endpoint().serial_device;
    ModbusLink link(server.endpoint(), bench.real_clock);
    EXPECT_EQ(link.read({RegisterTable::Input, 100}, "x"), 0.0);
  }
  EXPECT_FALSE(std::filesystem::exists(port.parent_path()));
}

TEST(TcpLink, AnEndpointThatCannotBeIsRefused) {
  ModbusEndpoint endpoint;
  endpoint.name = "bench";
  endpoint.host = "127.0.0.1";
  endpoint.unit_id = 300;
  EXPECT_THROW(ModbusLink(endpoint, std::make_shared<SystemClock>()), OutOfRange);
}

}  // namespace
}  // namespace lumitexel
