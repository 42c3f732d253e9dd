#include "drivers/modbus/modbus_wire.h"

#include <modbus/modbus.h>
#include <sys/select.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <sstream>

#include "drivers/error.h"
#include "drivers/modbus/serial_line_step.h"

namespace lumitexel {

struct ModbusWire::Context {
  modbus_t* modbus = nullptr;
  bool open = false;
  explicit Context(modbus_t* made) : modbus(made) {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() {
    close();
    modbus_free(modbus);
  }
  void close() {
    if (open) modbus_close(modbus);
    open = false;
  }
  // For the whole of a reply: with the time between bytes at 0, the library counts one time for all of them.
  void set_deadline(double timeout_s) {
    const auto all_us = static_cast<std::uint32_t>(std::max(1.0, std::round(timeout_s * 1e6)));
    modbus_set_response_timeout(modbus, all_us / 1'000'000, all_us % 1'000'000);
    modbus_set_byte_timeout(modbus, 0, 0);
  }
};

namespace {

modbus_t* new_context(const ModbusEndpoint& endpoint) {
  modbus_t* context =
      endpoint.host.empty()
          ? modbus_new_rtu(endpoint.serial_device.c_str(), endpoint.baud, endpoint.parity, 8, endpoint.stop_bits)
          : modbus_new_tcp(endpoint.host.c_str(), endpoint.port);
  if (context == nullptr || modbus_set_slave(context, endpoint.unit_id) != 0) {
    const std::string cause = modbus_strerror(errno);
    modbus_free(context);
    throw OutOfRange("controller " + endpoint.name + ": cannot be set up as described: " + cause);
  }
  // Its own recovery waits for the controller without bound.
  modbus_set_error_recovery(context, MODBUS_ERROR_RECOVERY_NONE);
  return context;
}

std::string no_answer(double timeout_s) {
  std::ostringstream text;
  text << "no answer within " << timeout_s << " s";
  return text.str();
}

WireAnswer::Kind kind_of(int error) {
  using enum WireAnswer::Kind;
  switch (error) {
    case EMBXILFUN:
    case EMBXILADD:
    case EMBXILVAL: return Refused;
    case EMBXSFAIL:
    case EMBXACK:
    case EMBXSBUSY:
    case EMBXNACK:
    case EMBXMEMPAR:
    case EMBXGPATH:
    case EMBXGTAR: return Busy;
    case ETIMEDOUT:
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBBADEXC:
    case EMBUNKEXC:
    case EMBMDATA:
    case EMBBADSLAVE: return OutOfStep;
    default: return Broken;
  }
}

}  // namespace

ModbusWire::ModbusWire(const ModbusEndpoint& endpoint)
    : context_(std::make_unique<Context>(new_context(endpoint))),
      unit_id_(endpoint.unit_id),
      serial_(endpoint.host.empty()) {}

ModbusWire::~ModbusWire() = default;

WireAnswer ModbusWire::connect(double timeout_s) {
  context_->close();
  context_->set_deadline(timeout_s);
  if (modbus_connect(context_->modbus) != 0) {
    // The library says "in progress" when it has waited for long enough.
    const bool late = errno == ETIMEDOUT || errno == EINPROGRESS;
    // A port that somebody has opened for himself alone (TIOCEXCL, as libmodbus does) or locked.
    const bool taken = serial_ && (errno == EBUSY || errno == EINVAL || errno == EAGAIN || errno == EACCES);
    const std::string library = modbus_strerror(errno);
    const std::string cause =
        late ? no_answer(timeout_s) : library + (taken ? " (is another program using the port?)" : "");
    return {WireAnswer::Kind::Broken, "cannot connect: " + cause};
  }
  context_->open = true;
  // The library waits by select(), which has no room for more.
  if (modbus_get_socket(context_->modbus) >= FD_SETSIZE) {
    context_->close();
    return {WireAnswer::Kind::Broken, "cannot connect: too many open files"};
  }
  return {};
}

WireAnswer ModbusWire::fall_in_step(double quiet_s, const GiveWay& give_way) {
  if (!context_->open) return {WireAnswer::Kind::Broken, "not connected"};
  if (!serial_) return {};
  const int line = modbus_get_socket(context_->modbus);
  const WireAnswer gone{WireAnswer::Kind::Broken, "the serial line is gone"};
  const LineQuiet quiet = drain(line, quiet_s, 5.0 * quiet_s, give_way);
  if (quiet == LineQuiet::Gone) return gone;
  if (quiet == LineQuiet::Babbling) return {WireAnswer::Kind::OutOfStep, "the serial line does not fall silent"};
  const EchoAnswer echo = ask_for_echo(line, unit_id_, ++nonce_, quiet_s, give_way);
  if (echo == EchoAnswer::Gone) return gone;
  if (echo == EchoAnswer::Echoed) {
    echoes_ = true;
    return {};
  }
  if (echo == EchoAnswer::GaveWay) return {WireAnswer::Kind::OutOfStep, "gave way to something urgent"};
  if (echoes_) return {WireAnswer::Kind::OutOfStep, no_answer(quiet_s)};
  return {};
}

WireAnswer ModbusWire::read(RegisterTable table, int address, std::span<std::uint16_t> words, double timeout_s) {
  if (!context_->open) return {WireAnswer::Kind::Broken, "not connected"};
  context_->set_deadline(timeout_s);
  modbus_t* const modbus = context_->modbus;
  const int count = static_cast<int>(words.size());
  if (table == RegisterTable::Holding) {
    return finish(modbus_read_registers(modbus, address, count, words.data()), words.size(), timeout_s);
  }
  if (table == RegisterTable::Input) {
    return finish(modbus_read_input_registers(modbus, address, count, words.data()), words.size(), timeout_s);
  }
  std::vector<std::uint8_t> bits(words.size());
  const int result = table == RegisterTable::Coil ? modbus_read_bits(modbus, address, count, bits.data())
                                                  : modbus_read_input_bits(modbus, address, count, bits.data());
  std::copy(bits.begin(), bits.end(), words.begin());
  return finish(result, words.size(), timeout_s);
}

WireAnswer ModbusWire::write(const ModbusWrite& write, double timeout_s) {
  if (!context_->open) return {WireAnswer::Kind::Broken, "not connected"};
  context_->set_deadline(timeout_s);
  modbus_t* const modbus = context_->modbus;
  const int count = static_cast<int>(write.words.size());
  if (write.table == RegisterTable::Holding) {
    const int result = count == 1 ? modbus_write_register(modbus, write.address, write.words[0])
                                  : modbus_write_registers(modbus, write.address, count, write.words.data());
    return finish(result, write.words.size(), timeout_s);
  }
  if (count == 1) return finish(modbus_write_bit(modbus, write.address, write.words[0]), 1, timeout_s);
  const std::vector<std::uint8_t> bits(write.words.begin(), write.words.end());
  return finish(modbus_write_bits(modbus, write.address, count, bits.data()), write.words.size(), timeout_s);
}

WireAnswer ModbusWire::finish(int result, std::size_t expected, double timeout_s) {
  if (result == static_cast<int>(expected)) return {};
  const int error = result < 0 ? errno : EMBBADDATA;
  const WireAnswer::Kind kind = kind_of(error);
  if (kind == WireAnswer::Kind::Broken) context_->close();
  return {kind, error == ETIMEDOUT ? no_answer(timeout_s) : modbus_strerror(error)};
}

}  // namespace lumitexel
