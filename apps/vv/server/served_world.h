// served_world.h: The world that vv serve shows: reads the first one at once and others in the
// background, and replaces its session. Owned by the server. [main thread]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/problems.h"
#include "server/flow.h"
#include "session/ending.h"
#include "session/session.h"
#include "session/world_loader.h"
#include "session/world_watch.h"

namespace vv::server {

class ServedWorld {
 public:
  struct Callbacks {
    // Receives the keys' actions that are neither the pilot's nor the session's.
    SessionViewers::OnAction onAction;
    // Opens a page of the web that an Anchor or a Script leads to.
    std::function<void(const std::string& url)> openPage;
    // Receives a message for everybody.
    std::function<void(const std::string& text)> onMessage;
    // The session ends: its nodes are to be let go.
    std::function<void()> onLeave;
  };
  // The options must outlive this object.
  ServedWorld(const Options& options, Callbacks callbacks);

  // Reads the world of the options and begins it. Throws the errors of loadWorld and Session.
  void openFirst();
  // Reads the world again, in the background, and keeps the leader's view.
  void reload();
  // Reads the world again; edits that are not saved are thrown away when that has been done. Throws
  // xvrml::EditError.
  void revert();
  // Tells whether this is under way.
  bool isReverting() const { return isReverted_; }
  // Loads the world with the edits that an earlier program has left. Throws xvrml::EditError.
  void recover();
  // Reloads the world if --watch is given and a file has changed, but not by an edit. now: seconds
  // of any clock.
  void watch(double now);
  // Takes over a world that has been read meanwhile. Returns true if there is a new session, which
  // has no guests. size: of the leader's pictures.
  bool take(PictureSize size);

  Session& session() { return *session_; }
  // Tells whether pictures have light that can be measured, and not colours for screens.
  bool hasLight() const { return options_.render.linear; }
  // Returns the event that goes to a viewpoint of the list. Names are not always unique: the text
  // must lead to this one.
  std::optional<InputEvent> viewpointEvent(int number);
  // Returns the name of the world that is being read; "": none.
  const std::string& loading() const { return loading_; }
  // Ends the session, or the process with `code` (session/ending.h).
  void end(int code) { stopOrExit(session_.get(), code); }

 private:
  void open(LoadRequest request, bool keepPlace);
  bool refuseWhileUnsaved() const;
  void openUrls(const std::vector<std::string>& urls, const std::string& base);
  void begin(std::unique_ptr<xvrml::World> world, const std::string& fragment, PictureSize size,
             LeftEdits* left);

  const Options& options_;
  Callbacks callbacks_;
  Problems problems_;
  WorldLoader loader_;
  std::unique_ptr<Session> session_;
  WorldWatch watch_{options_};
  std::string loading_;
  bool keepPlace_ = false;
  bool isReverted_ = false; // edits that are not saved are no reason to stay
  uint64_t saves_ = 0;      // saves of the session's editor when its files were watched
};

} // namespace vv::server
