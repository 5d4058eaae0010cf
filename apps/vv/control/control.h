// control.h: The control channel of a session: takes the commands of clients from the mailbox and
// does them while the session rests, and sends answers and events. Whoever runs sessions owns it:
// the window, a server of pages, or nobody who looks (unattended.h). [the browser's thread]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "options/options.h"
#include "session/session.h"
#include "session/world_loader.h"

namespace vv::control {

// Lists what a client may ask of the program.
struct Host {
  std::function<void(LoadRequest request)> open; // loads another world
  std::function<void()> quit;
};

class Control {
 public:
  // Listens at options.control and prints the address: "vv: control: listening at ADDRESS". Throws
  // UsageError and Failure.
  Control(const Options& options, Host host);
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  // Does the commands that wait, if the session rests. Call it often: after each wait. session:
  // null if there is no world yet. isLoading: one is being read. Returns true if a picture was
  // asked for that begins when the session advances.
  bool serve(Session* session, bool isLoading);
  // Forgets the session, which will be destroyed. Call it while the session rests.
  void detach();
  // Tells a client that waits for a world why there is none.
  void loadFailed(const std::string& why);
  // Waits for commands, at most these seconds.
  void wait(double seconds);
  // Tells whether commands wait for something: the end of a frame, a picture, a world.
  bool isBusy() const;
  // Tells whether a thread still writes the picture of a command, perhaps of a Control that has
  // ended.
  static bool isWriting();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv::control
