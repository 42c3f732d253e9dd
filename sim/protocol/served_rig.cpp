#include "sim/protocol/served_rig.h"

#include <sstream>

#include "drivers/error.h"
#include "sim/protocol/gige/gige_camera_server.h"
#include "sim/protocol/modbus/modbus_controller_server.h"
#include "sim/protocol/ptp/ptp_camera_server.h"

namespace lumitexel {
namespace {

void require_loopback(const std::string& address, const std::string& key) {
  if (address.starts_with("127.")) return;
  throw BadInput(key, "\"" + address + "\"", "an address of this machine alone, 127.x.y.z: simulated devices stay there");
}

// "ptpip:ADDRESS" or "ptpip:ADDRESS:COMMAND_PORT:EVENT_PORT".
PtpCameraOptions ptp_options(const GphotoConnection& connection) {
  if (!connection.port.starts_with("ptpip:")) {
    throw BadInput("hardware.camera.port", "\"" + connection.port + "\"", "\"ptpip:127.x.y.z\": USB is not simulated");
  }
  std::istringstream text(connection.port.substr(6));
  PtpCameraOptions options;
  std::string command, event;
  std::getline(text, options.address, ':');
  if (std::getline(text, command, ':') && std::getline(text, event)) {
    options.command_port = std::stoi(command);
    options.event_port = std::stoi(event);
  }
  options.iso_at_0_db = connection.iso_at_0_db;
  require_loopback(options.address, "hardware.camera.port");
  return options;
}

}  // namespace

ServedRig::ServedRig(const HardwareDescription& hardware, std::shared_ptr<SimulatedBench> bench,
                     std::shared_ptr<FaultSource> faults, const ServedRigOptions& options)
    : options_(options) {
  serve_camera(hardware, bench, faults);
  for (const auto& [name, endpoint] : hardware.controllers) serve_controller(name, hardware, bench, faults);
}

ServedRig::~ServedRig() = default;

void ServedRig::serve_camera(const HardwareDescription& hardware, const std::shared_ptr<SimulatedBench>& bench,
                             const std::shared_ptr<FaultSource>& faults) {
  if (const auto* aravis = std::get_if<AravisConnection>(&hardware.camera)) {
    require_loopback(aravis->address, "hardware.camera.address");
    GigeCameraOptions options = options_.gige;
    options.address = aravis->address;
    gige_ = std::make_unique<GigeCameraServer>(bench, options, faults);
    places_.push_back("camera: GigE Vision at " + aravis->address);
    return;
  }
  PtpCameraOptions options = ptp_options(std::get<GphotoConnection>(hardware.camera));
  options.late_reply_s = options_.ptp_late_by_s;
  ptp_ = std::make_unique<PtpCameraServer>(bench, faults, options);
  places_.push_back("camera: PTP/IP at " + ptp_->gphoto_port());
}

void ServedRig::serve_controller(const std::string& name, const HardwareDescription& hardware,
                                 const std::shared_ptr<SimulatedBench>& bench,
                                 const std::shared_ptr<FaultSource>& faults) {
  ModbusServerSettings settings;
  settings.endpoint = hardware.controllers.at(name);
  settings.late_by_s = options_.controller_late_by_s;
  if (!settings.endpoint.host.empty()) {
    require_loopback(settings.endpoint.host, "hardware.controllers." + name + ".host");
  }
  const auto axis = [&](BenchAxis which, const ModbusAxisMap& map) {
    if (map.controller == name) settings.axes[which] = map;
  };
  axis(BenchAxis::Turntable, hardware.turntable);
  axis(BenchAxis::LightAzimuth, hardware.light_azimuth);
  axis(BenchAxis::LightElevation, hardware.light_elevation);
  const auto lamp = [&](BenchLamp which, const ModbusLampMap& map) {
    if (map.controller == name) settings.lamps[which] = map;
  };
  lamp(BenchLamp::Point, hardware.point_light);
  lamp(BenchLamp::Ring, hardware.ring_flash);
  lamp(BenchLamp::Back, hardware.backlight);
  controllers_[name] = std::make_unique<ModbusControllerServer>(settings, bench, faults);
  const ModbusEndpoint& where = controllers_[name]->endpoint();
  std::ostringstream place;
  place << "controller " << name << ": Modbus ";
  if (where.host.empty()) place << "RTU at " << where.serial_device;
  else place << "TCP at " << where.host << ':' << where.port;
  place << ", unit " << where.unit_id;
  places_.push_back(place.str());
}

}  // namespace lumitexel
