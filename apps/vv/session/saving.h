// saving.h: Saves pictures of the window as files. [the browser's thread]
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "options/options.h"

namespace vv {

// Returns the samples per pixel up to which the window refines its picture.
int samplesInWindow(const Options& options);
// Returns the samples of each point that a sensor reads while the world runs.
int samplesOfSensors(const Options& options);

// Returns an unused file name: world-1.png, world-2.png and so on in the working folder.
std::string freeName(const std::string& world, const std::string& suffix);

// Encodes and writes pictures on a thread of its own, one at a time: the window must not stand
// still for a large file. Owned by a session.
class PictureWriter {
 public:
  PictureWriter() = default;
  ~PictureWriter(); // Waits for the file.
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  // Begins to write the channels of a picture; waits for an earlier file. falseColour: the end of
  // the scale of false colours for screens, or 0 if the picture chooses it; none: own colours.
  // note: is added to the message.
  void begin(picture::Picture picture, const std::string& path, uint32_t channels,
             std::optional<double> falseColour, const std::string& note = "");
  // Returns, once and also on the terminal, where the picture was saved or why it was not; "" until
  // that is known.
  std::string takeMessage();
  void wait(); // until the file is written

 private:
  std::thread thread_;
  std::atomic<bool> done_{false};
  // Written by the thread before `done_`: a message for the user, and whether it is an error.
  std::string told_;
  bool failed_ = false;
};

} // namespace vv
