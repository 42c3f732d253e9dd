#include "rig/stage.h"

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr const char* kAskedFor = "stage: asked the operator for ";

std::optional<Prop> last_asked_for(const SessionStore& session) {
  std::optional<Prop> prop;
  for (const SessionEvent& event : session.events()) {
    if (event.text.starts_with(kAskedFor)) prop = prop_from_string(event.text.substr(std::string(kAskedFor).size()));
  }
  return prop;
}

}  // namespace

Stage::Stage(RigDevices& devices, SessionStore& session) : devices_(devices), session_(session) {
  if (devices.stage) return;
  const std::optional<Prop> asked = last_asked_for(session);
  placed_ = asked.value_or(Prop{});
  if (asked) {
    session.log_event("info", "stage: " + to_string(*asked) + " stands there, on the operator's word",
                      devices.clock->utc_ns());
  }
}

void Stage::show(const Prop& prop, std::stop_token stop) {
  if (placed_ == prop) return;
  if (!devices_.stage) {
    session_.log_event("info", kAskedFor + to_string(prop), devices_.clock->utc_ns());
    throw Error("the next shots need another thing before the camera: " + instruction_for(prop));
  }
  placed_.reset();  // unknown until it stands
  devices_.stage->place(prop, stop);
  placed_ = prop;
}

}  // namespace lumitexel
