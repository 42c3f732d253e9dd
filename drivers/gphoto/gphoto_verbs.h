// One request to the worker, carried out (worker_message.h lists them).
#pragma once

#include <memory>

#include "drivers/gphoto/gphoto_session.h"
#include "drivers/gphoto/worker_message.h"

namespace lumitexel {

// session: the connected camera or null; opened and closed by verbs. Never throws: failures are answers.
WorkerMessage carry_out(const WorkerMessage& request, std::unique_ptr<GphotoSession>& session);

}  // namespace lumitexel
