#include "sim/protocol/modbus/simulated_controller.h"

#include <algorithm>

#include "drivers/error.h"
#include "drivers/modbus/modbus_words.h"

namespace lumitexel {
namespace {

double home_place(const AxisLimits& limits) { return std::clamp(0.0, limits.min, limits.max); }

bool contains(const ModbusRequest& request, const ModbusRegister& where) {
  return request.table == where.table && where.address >= request.address &&
         where.address + word_count(where) <= request.address + request.count;
}

}  // namespace

SimulatedController::SimulatedController(std::shared_ptr<SimulatedBench> bench, const ModbusEndpoint& endpoint,
                                         const std::map<BenchAxis, ModbusAxisMap>& axes,
                                         const std::map<BenchLamp, ModbusLampMap>& lamps,
                                         const ControllerBehaviour& behaviour)
    : bench_(std::move(bench)), endpoint_(endpoint), behaviour_(behaviour) {
  for (const auto& [axis, map] : axes) {
    add_axis(axis, map);
    add_axis_state(axis, map);
  }
  for (const auto& [lamp, map] : lamps) add_lamp(lamp, map);
  if (endpoint_.watchdog) {
    add_command(*endpoint_.watchdog, [this] { last_kick_ = std::chrono::steady_clock::now(); });
  }
}

void SimulatedController::add_command(const ModbusCommand& command, std::function<void()> act, Field field) {
  field.where = command.where;
  field.take = [value = command.value, act = std::move(act)](double written) {
    if (written == value) act();
    return written == value || written == 0.0;  // 0 rests a command's register
  };
  if (field.risk) {
    field.risk = [value = command.value, risk = field.risk](double written) {
      return written == value ? risk(written) : Fault::None;
    };
  }
  fields_.push_back(std::move(field));
}

void SimulatedController::add_axis(BenchAxis axis, const ModbusAxisMap& map) {
  const AxisLimits limits = bench_->limits(axis);
  const std::string name = to_string(axis);
  for (const double end : {limits.min, limits.max}) {
    words_from_value(map.position, end, endpoint_.word_order, name + " position");
    words_from_value(map.target, end, endpoint_.word_order, name + " target");
  }
  axes_[axis] = {.homed = behaviour_.homed, .target = bench_->motion(axis).target};
  Field moves;
  moves.risk = [](double) { return Fault::StuckAxis; };
  moves.suffer = [this, axis] {
    bench_->jam(axis, true);
    axes_[axis].fault = behaviour_.stuck_axis_fault;
  };
  const auto go = [this, axis] {
    axes_[axis].fault = 0;
    axes_[axis].homing = false;
    bench_->start_move(axis, axes_[axis].target);
  };
  Field target = map.start ? Field{} : moves;
  target.where = map.target;
  target.value = [this, axis] { return axes_[axis].target; };
  target.take = [this, axis, go, at_once = !map.start](double place) {
    axes_[axis].target = place;
    if (at_once) go();
    return true;
  };
  fields_.push_back(target);
  if (map.start) add_command(*map.start, go, moves);
  if (map.home) {
    add_command(*map.home, [this, axis, go, place = home_place(limits)] {
      axes_[axis].target = place;
      go();
      axes_[axis].homed = false;
      axes_[axis].homing = true;
    }, moves);
  }
}

void SimulatedController::add_axis_state(BenchAxis axis, const ModbusAxisMap& map) {
  const auto readable = [this](const std::optional<ModbusRegister>& where, std::function<double()> value) {
    if (where) fields_.push_back({.where = *where, .value = std::move(value), .take = {}, .risk = {}, .suffer = {}});
  };
  readable(map.position, [this, axis] { return bench_->motion(axis).position; });
  readable(map.moving, [this, axis] { return bench_->motion(axis).moving ? 1.0 : 0.0; });
  readable(map.homed, [this, axis] { return is_homed(axis) ? 1.0 : 0.0; });
  readable(map.fault, [this, axis] { return static_cast<double>(axes_[axis].fault); });
  if (!map.stop) return;
  add_command(*map.stop, [this, axis] {  // it also acknowledges a fault
    record(std::string(to_string(axis)) + " stop");
    bench_->halt(axis);
    axes_[axis].homing = false;
    axes_[axis].fault = 0;
  });
}

void SimulatedController::add_lamp(BenchLamp lamp, const ModbusLampMap& map) {
  lamps_[lamp] = {};
  Field output;
  output.where = map.output;
  output.value = [this, lamp] { return lamps_[lamp].commanded ? 1.0 : 0.0; };
  output.take = [this, lamp](double on) {
    if (on != 0.0 && on != 1.0) return false;
    if (on == 0.0) record(std::string(to_string(lamp)) + " off");
    lamps_[lamp] = {.commanded = on == 1.0, .fault = 0};
    bench_->switch_lamp(lamp, on == 1.0);
    return true;
  };
  output.risk = [](double on) { return on == 1.0 ? Fault::LampFails : Fault::None; };
  output.suffer = [this, lamp] {
    bench_->break_lamp(lamp, true);
    lamps_[lamp].fault = behaviour_.lamp_fault;
  };
  fields_.push_back(output);
  const auto readable = [this](const std::optional<ModbusRegister>& where, std::function<double()> value) {
    if (where) fields_.push_back({.where = *where, .value = std::move(value), .take = {}, .risk = {}, .suffer = {}});
  };
  readable(map.lit, [this, lamp] { return bench_->is_lit(lamp) ? 1.0 : 0.0; });
  readable(map.fault, [this, lamp] { return static_cast<double>(lamps_[lamp].fault); });
}

// An axis that was jammed or halted on its way home stands elsewhere and has not found its reference.
bool SimulatedController::is_homed(BenchAxis axis) {
  AxisState& state = axes_[axis];
  const BenchMotion motion = bench_->motion(axis);
  if (state.homing && !motion.moving && motion.position == home_place(bench_->limits(axis))) {
    state.homed = true;
    state.homing = false;
  }
  return state.homed;
}

double SimulatedController::value_in(const Field& field, const ModbusRequest& request) const {
  const std::span<const std::uint16_t> words(request.words);
  const auto at = static_cast<std::size_t>(field.where.address - request.address);
  return value_from_words(field.where, words.subspan(at, static_cast<std::size_t>(word_count(field.where))),
                          endpoint_.word_order, "written value");
}

std::vector<const SimulatedController::Field*> SimulatedController::written_fields(const ModbusRequest& request) const {
  std::vector<const Field*> fields;
  std::vector<bool> covered(static_cast<std::size_t>(request.count), false);
  for (const Field& field : fields_) {
    if (!field.take || !contains(request, field.where)) continue;
    fields.push_back(&field);
    std::fill_n(covered.begin() + (field.where.address - request.address), word_count(field.where), true);
  }
  if (std::find(covered.begin(), covered.end(), false) != covered.end()) return {};
  return fields;
}

std::vector<Fault> SimulatedController::possible_faults(const ModbusRequest& request) const {
  std::vector<Fault> possible;
  if (request.error != ModbusException::None || !request.writes) return possible;
  try {
    for (const Field* field : written_fields(request)) {
      const Fault fault = field->risk ? field->risk(value_in(*field, request)) : Fault::None;
      if (fault != Fault::None) possible.push_back(fault);
    }
  } catch (const Error&) {  // a float that is no number starts nothing
  }
  return possible;
}

// Several commands may share a register, each with its own value: one of them has to know the value.
ModbusException SimulatedController::write(const ModbusRequest& request, Fault fault) {
  const std::vector<const Field*> fields = written_fields(request);
  if (fields.empty()) return ModbusException::IllegalAddress;
  std::map<int, bool> taken;
  for (const Field* field : fields) {
    const double value = value_in(*field, request);
    const bool took = field->take(value);
    taken[field->where.address] = taken[field->where.address] || took;
    if (took && fault != Fault::None && field->risk && field->risk(value) == fault) field->suffer();
  }
  const bool all = std::all_of(taken.begin(), taken.end(), [](const auto& entry) { return entry.second; });
  return all ? ModbusException::None : ModbusException::IllegalValue;
}

std::optional<std::vector<std::uint16_t>> SimulatedController::read(const ModbusRequest& request) const {
  std::vector<std::uint16_t> words(static_cast<std::size_t>(request.count), 0);
  std::vector<bool> covered(words.size(), false);
  for (const Field& field : fields_) {
    if (!contains(request, field.where)) continue;
    const auto at = field.where.address - request.address;
    const std::vector<std::uint16_t> part =
        words_from_value(field.where, field.value ? field.value() : 0.0, endpoint_.word_order, "read value");
    std::copy(part.begin(), part.end(), words.begin() + at);
    std::fill_n(covered.begin() + at, part.size(), true);
  }
  if (std::find(covered.begin(), covered.end(), false) != covered.end()) return std::nullopt;
  return words;
}

Bytes SimulatedController::answer(const Bytes& pdu, Fault fault) {
  const ModbusRequest request = parse_request(pdu);
  if (request.error != ModbusException::None) return exception_reply(pdu, request.error);
  if (behaviour_.refuses_groups && request.several && request.table == RegisterTable::Coil) {
    return exception_reply(pdu, ModbusException::IllegalFunction);
  }
  const std::lock_guard lock(mutex_);
  try {
    if (request.writes) {
      const ModbusException error = write(request, fault);
      return error == ModbusException::None ? write_reply(pdu) : exception_reply(pdu, error);
    }
    const auto words = read(request);
    return words ? read_reply(pdu, *words) : exception_reply(pdu, ModbusException::IllegalAddress);
  } catch (const Error&) {  // a written float that is no number, a state that its register cannot hold
    return exception_reply(pdu, request.writes ? ModbusException::IllegalValue : ModbusException::Failure);
  }
}

void SimulatedController::check_watchdog(std::chrono::steady_clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (!last_kick_ || now - *last_kick_ < std::chrono::duration<double>(endpoint_.watchdog_period_s)) return;
  last_kick_.reset();
  ++watchdog_trips_;
  switch_off_everything("watchdog: ");
}

void SimulatedController::switch_off_everything(const std::string& why) {
  for (auto& [lamp, state] : lamps_) {
    bench_->switch_lamp(lamp, false);
    state = {};
    record(why + to_string(lamp) + " off");
  }
  for (auto& [axis, state] : axes_) {
    bench_->halt(axis);
    state.homing = false;
    record(why + to_string(axis) + " stop");
  }
}

std::vector<ReceivedStop> SimulatedController::received_stops() const {
  const std::lock_guard lock(mutex_);
  return stops_;
}

int SimulatedController::watchdog_trips() const {
  const std::lock_guard lock(mutex_);
  return watchdog_trips_;
}

}  // namespace lumitexel
