#include "session/ending.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "process/messages.h"
#include "process/signals.h"
#include "session/session.h"
#include "session/world_loader.h"

namespace vv {

void keepEdits(Session* session) {
  if (!session) return;
  // The time limit after a signal would leave the file as it was some seconds ago.
  interruptHandled();
  Journal& journal = session->editor().journal();
  const std::string path = journal.keep(), &world = session->browser().world().path;
  if (!path.empty())
    say(fmt::format("vv: the unsaved edits of {} are in {}: a vv that opens the file offers them",
                    world, path));
  else if (!journal.failure().empty())
    sayError(fmt::format("the unsaved edits of {} are lost: {}", world, journal.failure()));
  limitInterrupt();
}

void stopOrExit(Session* session, int code, Others others) {
  constexpr double patience = .5; // seconds
  const bool stopped = !session || session->stop(patience);
  const bool isReading = WorldLoader::working() || WorldEditor::isReading();
  if (stopped && !isReading && others == Others::rest) return;
  picture::removeTemporaries();
  std::fflush(nullptr);
  ::_exit(code);
}

} // namespace vv
