// The way to make one controller's part of the rig safe: lamps off, axes stopped, in few requests that were made up in
// advance, over a connection that is up already and that nobody else waits on.
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/register_map.h"

namespace lumitexel {

// Thread-safe.
class ModbusSafety {
 public:
  // Lamps and axes of other controllers than `link`'s are left out, so that all of a rig's may be given; so are axes
  // without a stop command, which no rig's file may have.
  // link: one of its own by TCP (connect_for_safety). A serial line has one master: there it must be the link that the
  // devices use, where make_safe() goes before everything but the request that is under way.
  // Throws OutOfRange for commands that their registers cannot hold.
  ModbusSafety(std::shared_ptr<ModbusLink> link, const std::vector<ModbusLampMap>& lamps,
               const std::vector<ModbusAxisMap>& axes);

  // All lamps off, all axes with a stop command stopped; true if the controller has acknowledged all of it. 50 ms for
  // each request, adjoining registers in one at the first try, each in its own at the second (a controller may not know
  // the other way), see ModbusLink::write_urgently. Two connections' requests may cross: a "lamp on" that
  // the sequencer was sending at the same moment may be carried out after this. So stop the sequencer (its stop token)
  // first, and call this again once it has stopped.
  bool make_safe() noexcept;

  // Writes the controller's watchdog register, or reads something if it has none, and reconnects if need be: to be
  // called every watchdog_period_s / 3 or so by the thread whose death the watchdog is to notice. True if answered.
  bool kick_watchdog() noexcept;

 private:
  std::shared_ptr<ModbusLink> link_;
  std::vector<ModbusWrite> together_, one_by_one_, watchdog_;
  std::optional<ModbusRegister> any_register_;
};

// A second connection to the device link's controller, or, on a serial line, that link itself. Throws as ModbusLink.
std::shared_ptr<ModbusLink> connect_for_safety(const std::shared_ptr<ModbusLink>& devices, std::shared_ptr<Clock> clock,
                                               std::stop_token stop = {});

}  // namespace lumitexel
