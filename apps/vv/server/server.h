// server.h: Runs `vv serve`: shows a world on a page. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Serves the page until the process is interrupted, and returns an exit code; error messages have
// been printed. `arguments` are those of the command line. Throws Failure if the world cannot be
// read, nobody can listen at the address, or vv was built without libwebsockets; UsageError if
// other machines could see the page without a token.
int runServer(const Options& options, const std::vector<std::string>& arguments);

// Returns the library that serves the page, with its version; "": vv was built without it.
std::string serverLibrary();

} // namespace vv
