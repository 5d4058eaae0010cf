// picture_saver.h: Saves the picture of an instant of a session. If something moves, the world and
// the viewer are held until the still picture has all its samples. Owned by a session. [the
// browser's thread]
#pragma once

#include <functional>
#include <string>

#include "options/options.h"
#include "session/saving.h"
#include "session/session_viewers.h"

namespace vv {

class PictureSaver {
 public:
  // channels: those of the files. Scripts wait for finished pictures: `scripted`. ended: is called
  // when the world goes on, because the picture is saved or given up. The arguments must live as
  // long.
  PictureSaver(SessionViewer& viewer, const Options& options, uint32_t channels, bool scripted,
               std::function<void()> ended)
      : viewer_(viewer), options_(options), channels_(channels), scripted_(scripted),
        ended_(std::move(ended)) {}

  // Saves the true picture of this instant. If nothing moves, that is the picture as it is so far.
  // A message follows (takeMessage).
  void save(const std::string& path);
  // Saves the picture for a script when all its samples are taken; the script waits until then.
  void saveWhenFinished(const std::string& path);
  // Tells whether the world is held for a picture.
  bool isWaiting() const { return !path_.empty(); }
  // Writes the picture that is waited for if it has all its samples.
  void writeIfFinished();
  // Gives up the picture that the user has asked for. Returns false if none is waited for.
  bool giveUp();
  // Gives up the picture that is waited for because of a failure.
  void fail(const std::string& why);
  // Returns what is waited for, as a line for the user; "" if nothing is.
  std::string text() const;
  // Ends the saving before the session ends: the picture that is waited for is saved as it is so
  // far, and the last file is complete when it returns. Returns the message about it, which has
  // also been printed.
  std::string end();
  // Waits for the last file, so that its name is taken.
  void finishWriting() { writer_.wait(); }
  // Returns, once, what has become of the last picture; "" if there is nothing to say.
  std::string takeMessage();

 private:
  void write(picture::Picture picture, const std::string& note = "");

  SessionViewer& viewer_;
  const Options& options_;
  const uint32_t channels_;
  const bool scripted_;
  const std::function<void()> ended_;
  std::string path_, message_; // path_: the file of the finished picture; "": none is wanted
  enum class Asker : uint8_t { script, user };
  Asker asker_ = Asker::script; // who wants that file
  PictureWriter writer_;
};

} // namespace vv
