// Every verb through every fault, at every one of the verb's first operations, over both transports.
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "modbus_bench.h"

namespace lumitexel {
namespace {

enum class Verb { Read, Write, Move, SwitchOn, ForceOff, Halt, Home, MakeSafe };
constexpr std::array<const char*, 8> kVerbNames{"Read",     "Write", "Move", "SwitchOn",
                                                "ForceOff", "Halt",  "Home", "MakeSafe"};
constexpr std::array<Fault, 6> kConnectionFaults{Fault::Mute,    Fault::LateReply, Fault::Exception,
                                                 Fault::Garbage, Fault::HalfReply, Fault::Disconnect};

using FaultCase = std::tuple<Transport, Verb, Fault>;

std::string name_of(const testing::TestParamInfo<FaultCase>& info) {
  std::string fault = to_string(std::get<2>(info.param));
  std::erase(fault, '_');
  return std::string(to_string(std::get<0>(info.param))) + "_" +
         kVerbNames[static_cast<std::size_t>(std::get<1>(info.param))] + "_" + fault;
}

ModbusServerSettings settings_for(const FaultCase& chosen) {
  ModbusServerSettings settings = quick_settings(std::get<0>(chosen));
  settings.behaviour.homed = std::get<1>(chosen) != Verb::Home;
  return settings;
}

// Does the verb once and says whether it did what it should, as the bench itself sees it.
class Doing {
 public:
  Doing(const FaultCase& chosen, const ModbusBench& bench)
      : verb_(std::get<1>(chosen)),
        bench_(bench),
        table_(bench.axis(BenchAxis::Turntable)),
        lamp_(bench.lamp(BenchLamp::Point)),
        safety_(verb_ == Verb::MakeSafe ? bench.safety() : nullptr) {}

  // So that there is something to do. `round` makes each time another one.
  void prepare(int round) {
    round_ = round;
    const bool lit = verb_ == Verb::ForceOff || verb_ == Verb::MakeSafe;
    for (const BenchLamp lamp : kBenchLamps) bench_.bench->switch_lamp(lamp, lit);
    const bool moving = verb_ == Verb::Halt || verb_ == Verb::MakeSafe;
    if (moving) bench_.bench->start_move(BenchAxis::LightAzimuth, round % 2 == 0 ? 110.0 : -110.0);
    if (moving)
      bench_.bench->start_move(BenchAxis::Turntable, bench_.bench->motion(BenchAxis::Turntable).position + 170.0);
  }

  void act() {
    switch (verb_) {
      case Verb::Read: read_ = bench_.link->read(map(BenchAxis::Turntable).position, "turntable position"); return;
      case Verb::Write:
        bench_.link->write(map(BenchAxis::LightAzimuth).target, -7.5 - round_, "azimuth target");
        return;
      case Verb::Move: return table_->move_to(place(), {});
      case Verb::SwitchOn: return lamp_->switch_to(true, {});
      case Verb::ForceOff: return lamp_->force_off();
      case Verb::Halt: return table_->halt();
      case Verb::Home: return table_->home({});
      case Verb::MakeSafe: made_safe_ = safety_->make_safe(); return;
    }
  }

  void expect_done() {
    const SimulatedBench& bench = *bench_.bench;
    switch (verb_) {
      case Verb::Read: EXPECT_EQ(read_, bench.motion(BenchAxis::Turntable).position); return;
      case Verb::Write:
        EXPECT_EQ(bench_.link->read(map(BenchAxis::LightAzimuth).target, "azimuth target"), -7.5 - round_);
        return;
      case Verb::Move: EXPECT_EQ(bench.motion(BenchAxis::Turntable).position, place()); return;
      case Verb::SwitchOn: EXPECT_TRUE(bench.is_lit(BenchLamp::Point)); return;
      case Verb::ForceOff: EXPECT_FALSE(bench.is_lit(BenchLamp::Point)); return;
      case Verb::Halt: EXPECT_FALSE(bench.motion(BenchAxis::Turntable).moving); return;
      case Verb::Home: EXPECT_EQ(bench_.link->read(*map(BenchAxis::Turntable).homed, "homed"), 1.0); return;
      case Verb::MakeSafe: EXPECT_TRUE(made_safe_); return expect_safe();
    }
  }

 private:
  double place() const { return 10.0 + round_; }
  const ModbusAxisMap& map(BenchAxis axis) const { return bench_.settings.axes.at(axis); }
  void expect_safe() {
    for (const BenchLamp lamp : kBenchLamps) EXPECT_FALSE(bench_.bench->is_lit(lamp)) << to_string(lamp);
    for (const BenchAxis axis : kBenchAxes) EXPECT_FALSE(bench_.bench->motion(axis).moving) << to_string(axis);
  }

  Verb verb_;
  const ModbusBench& bench_;
  std::unique_ptr<ModbusAxis> table_;
  std::unique_ptr<ModbusLamp> lamp_;
  std::unique_ptr<ModbusSafety> safety_;
  int round_ = 0;
  double read_ = -1.0;
  bool made_safe_ = false;
};

class EveryFault : public testing::TestWithParam<FaultCase> {};
INSTANTIATE_TEST_SUITE_P(In, EveryFault,
                         testing::Combine(testing::Values(Transport::Tcp, Transport::Rtu),
                                          testing::Values(Verb::Read, Verb::Write, Verb::Move, Verb::SwitchOn,
                                                          Verb::ForceOff, Verb::Halt, Verb::Home, Verb::MakeSafe),
                                          testing::ValuesIn(kConnectionFaults)),
                         name_of);

// A single fault, wherever it strikes, changes nothing in what comes of the verb.
TEST_P(EveryFault, ThatStrikesOnceIsOvercome) {
  constexpr int kPlaces = 6;
  const ModbusBench bench(settings_for(GetParam()));
  Doing doing(GetParam(), bench);
  int struck = 0;
  for (int place = 0; place < kPlaces; ++place) {
    SCOPED_TRACE("operation " + std::to_string(place));
    const std::size_t before = bench.faults->injected().size();
    doing.prepare(place);
    bench.faults->arm_one(std::get<2>(GetParam()), place);
    EXPECT_LT(seconds_of([&] { doing.act(); }), 3.0);
    bench.faults->disarm();
    doing.expect_done();
    if (bench.faults->injected().size() == before) break;  // the verb has no more operations
    ++struck;
  }
  EXPECT_GE(struck, 1);
}

// Replies that are always late or always cut short are to a link what no replies are.
class LastingFault : public testing::TestWithParam<FaultCase> {};
INSTANTIATE_TEST_SUITE_P(In, LastingFault,
                         testing::Combine(testing::Values(Transport::Tcp, Transport::Rtu),
                                          testing::Values(Verb::Read, Verb::Write, Verb::Move, Verb::SwitchOn,
                                                          Verb::ForceOff, Verb::Home, Verb::MakeSafe),
                                          testing::Values(Fault::Mute, Fault::Exception, Fault::Garbage,
                                                          Fault::Disconnect)),
                         name_of);

// A fault that stays ends, within the deadline, in the error that names the controller; and when it has passed, the
// same devices work again.
TEST_P(LastingFault, IsAnErrorThatNamesTheController) {
  ModbusServerSettings settings = settings_for(GetParam());
  settings.endpoint.give_up_s = 0.2;  // a busy machine stands still for 60 ms now and then
  // Exceptions come at once; a busy machine's own delay must not be the last thing that happens.
  if (std::get<2>(GetParam()) == Fault::Exception) settings.endpoint.response_timeout_s = 0.1;
  const ModbusBench bench(settings);
  Doing doing(GetParam(), bench);
  const Fault fault = std::get<2>(GetParam());
  const Verb verb = std::get<1>(GetParam());
  const bool silent = verb == Verb::ForceOff || verb == Verb::Halt || verb == Verb::MakeSafe;  // these never throw
  const bool serial = std::get<0>(GetParam()) == Transport::Rtu;
  doing.prepare(1);
  bench.faults->arm_all(fault);
  const double took_s = seconds_of([&] {
    if (silent) return doing.act();
    try {
      doing.act();
      ADD_FAILURE() << "threw nothing";
    } catch (const Disconnected& error) {
      EXPECT_NE(fault, Fault::Exception);
      EXPECT_NE(std::string(error.what()).find("controller bench: "), std::string::npos) << error.what();
    } catch (const Protocol& error) {
      EXPECT_EQ(fault, Fault::Exception);
      EXPECT_NE(std::string(error.what()).find("controller bench: "), std::string::npos) << error.what();
    }
  });
  EXPECT_LT(took_s, 1.5);
  bench.faults->disarm();
  if (fault == Fault::Disconnect && serial)
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.1, {});  // plugged in again
  doing.prepare(2);
  doing.act();
  doing.expect_done();
}

TEST(ManyFaults, AtRandomNeverMakeAReadingOrAMotionWrong) {
  for (const Transport transport : {Transport::Tcp, Transport::Rtu}) {
    const ModbusBench bench(transport);
    const auto table = bench.axis(BenchAxis::Turntable);
    const auto elevation = bench.axis(BenchAxis::LightElevation);
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(std::string(to_string(transport)) + " " + std::to_string(i));
      bench.faults->arm_one(kConnectionFaults[static_cast<std::size_t>(i) % kConnectionFaults.size()], i % 7);
      table->move_to(3.7 * i, {});
      EXPECT_EQ(bench.bench->motion(BenchAxis::Turntable).position, std::round(3700.0 * i) / 1000.0);
      elevation->move_to(-20.0 + 2.5 * i, {});
      EXPECT_EQ(elevation->position(), -20.0 + 2.5 * i);
    }
  }
}

}  // namespace
}  // namespace lumitexel
