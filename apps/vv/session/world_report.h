// world_report.h: Makes the report of a session: it asks for the true picture of the instant, and
// writes a page and a table beside the file of the world, or hands them over. Owned by a face of
// the editor. [the browser's thread]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "edit/probes.h"
#include "session/session.h"

namespace vv {

class WorldReport {
 public:
  WorldReport();
  ~WorldReport(); // Waits for the files.
  // Takes the page and the table instead of files. Returns what the user is told. [a thread of its
  // own]
  using Deliver = std::function<std::string(std::string page, std::string table)>;

  // Begins a report, or gives up the one that still waits for its picture. before: a picture that
  // is shown beside it; null: none. arguments: of the command line. [while the world can be used]
  void begin(Session& session, const Probes& probes, const picture::Picture* before,
             const std::vector<std::string>& arguments, Deliver deliver = {});
  // Tells whether a report waits for its picture.
  bool isWaiting() const;
  // Gives up such a report: no file is written.
  void giveUp(Session& session);
  // Returns what it is doing, as a line for the user; "" if there is nothing to do. Gives up a
  // report whose picture would show later edits.
  std::string progress(Session& session) const;
  // Forgets the session, because it ends. Files that are being written are finished.
  void reset();
  // Returns, once, what has become of the report, which is also printed if it is in files; "" if
  // there is nothing to say.
  std::string takeMessage();

 private:
  struct Work;
  static void finish(Work& work);

  std::shared_ptr<Work> work_;                 // the callback of the picture has it, too
  std::vector<std::shared_ptr<Work>> earlier_; // other sessions, whose files are being written
};

} // namespace vv
