// address.h: Where vv serve listens, with which token, and what it prints about that. [main thread]
#pragma once

#include <string>

#include "options/options.h"
#include "server/host.h"

namespace vv::server {

// Returns the addresses, port and token that the options and the environment name. Throws
// UsageError if a token is unusable, or if other machines could see the page without one; Failure
// if a file with a token cannot be read.
HostOptions hostOptionsOf(const ServeOptions& options);

// Returns the URL of the page. A token that this program has made is part of it.
std::string urlOf(const ServeOptions& options, const HostOptions& host, int port);
// Returns the URL of the page for those who may edit; "" if nobody may.
std::string editUrlOf(const HostOptions& host, int port);

} // namespace vv::server
