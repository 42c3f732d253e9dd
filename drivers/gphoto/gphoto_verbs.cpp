#include "drivers/gphoto/gphoto_verbs.h"

#include "drivers/error.h"

namespace lumitexel {
namespace {

GphotoSession& connected(const std::unique_ptr<GphotoSession>& session) {
  if (!session) throw Protocol("no camera is open");
  return *session;
}

WorkerMessage carried_out(const WorkerMessage& request, std::unique_ptr<GphotoSession>& session) {
  const std::string& verb = request.field("verb");
  const auto path = [&] { return CardPath{request.field("folder"), request.field("file")}; };
  WorkerMessage answer;
  if (verb == "open") {
    session.reset();
    session = std::make_unique<GphotoSession>(request.field("model"), request.field("port"));
  } else if (verb == "close") {
    session.reset();
  } else if (verb == "set") {
    connected(session).set(request.field("name"), request.field("value"));
  } else if (verb == "get") {
    answer.fields["value"] = connected(session).get(request.field("name"));
  } else if (verb == "choices") {
    answer.texts = connected(session).choices(request.field("name"));
  } else if (verb == "capture") {
    const CardPath taken = connected(session).capture(std::stod(request.field("timeout_s")));
    answer.fields = {{"folder", taken.folder}, {"file", taken.file}};
  } else if (verb == "download") {
    answer.bytes = connected(session).download(path());
  } else if (verb == "remove") {
    connected(session).remove(path());
  } else {
    throw Protocol("unknown verb '" + verb + "'");
  }
  return answer;
}

WorkerMessage failure(const char* cause, const std::exception& error) {
  return {{{"cause", cause}, {"text", error.what()}}, {}, {}};
}

}  // namespace

WorkerMessage carry_out(const WorkerMessage& request, std::unique_ptr<GphotoSession>& session) {
  try {
    return carried_out(request, session);
  } catch (const Timeout& error) {
    return failure("timeout", error);
  } catch (const Disconnected& error) {
    return failure("disconnected", error);
  } catch (const OutOfRange& error) {
    return failure("out_of_range", error);
  } catch (const StorageFull& error) {
    return failure("storage_full", error);
  } catch (const std::exception& error) {
    return failure("protocol", error);
  }
}

}  // namespace lumitexel
