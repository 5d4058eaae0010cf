// no_server.cpp: Replaces the page in a build without libwebsockets.
#include "server/server.h"

namespace vv {

int runServer(const Options&, const std::vector<std::string>&) {
  throw Failure{exitRender, "no page: vv was built without libwebsockets"};
}

std::string serverLibrary() { return ""; }

} // namespace vv
