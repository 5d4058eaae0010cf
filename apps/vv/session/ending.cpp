#include "session/ending.h"

#include <cstdio>

#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "session/session.h"
#include "session/world_loader.h"

namespace vv {

void stopOrExit(Session* session, int code, Others others) {
  constexpr double patience = .5; // seconds
  const bool stopped = !session || session->stop(patience);
  if (stopped && !WorldLoader::working() && others == Others::rest) return;
  picture::removeTemporaries();
  std::fflush(nullptr);
  ::_exit(code);
}

} // namespace vv
