#include "session/picture_saver.h"

#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "process/messages.h"

namespace vv {

void PictureSaver::save(const std::string& path) {
  picture::Picture picture;
  if (isWaiting()) {
    message_ = fmt::format("{} is not saved: another picture is waited for", path);
  } else if (!scripted_ && !viewer_.isOutdated() && viewer_.pictures.copyStill(picture)) {
    path_ = path;
    write(std::move(picture));
  } else {
    path_ = path;
    asker_ = Asker::user;
  }
}

void PictureSaver::saveWhenFinished(const std::string& path) {
  if (isWaiting()) fail("another picture is wanted");
  path_ = path;
  asker_ = Asker::script;
}

void PictureSaver::writeIfFinished() {
  picture::Picture picture;
  if (!isWaiting() || !viewer_.pictures.isFinished(viewer_.pilot) ||
      !viewer_.pictures.copyStill(picture))
    return;
  write(std::move(picture));
  ended_();
}

bool PictureSaver::giveUp() {
  if (!isWaiting() || asker_ == Asker::script) return false;
  fail("given up");
  return true;
}

void PictureSaver::fail(const std::string& why) {
  message_ = fmt::format("{} is not saved: {}", std::exchange(path_, {}), why);
  say("vv: " + message_);
  ended_();
}

std::string PictureSaver::text() const {
  if (!isWaiting() || asker_ == Asker::script) return {};
  const double taken = viewer_.pictures.hasStill() ? viewer_.pictures.facts().samples : 0;
  return fmt::format("Saving the picture of this instant: {:.0f} of {} samples; Escape gives up",
                     taken, options_.render.samples);
}

std::string PictureSaver::end() {
  if (isWaiting()) {
    PictureLoop& pictures = viewer_.pictures;
    picture::Picture picture;
    bool copied = pictures.copyStill(picture);
    // For a moment, while a frame ends, there is no copy.
    for (int i = 0; i < 1000 && !copied && pictures.hasStill(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      copied = pictures.copyStill(picture);
    }
    if (copied)
      write(std::move(picture), fmt::format(", with {:.0f} of {} samples", pictures.facts().samples,
                                            options_.render.samples));
    else
      fail("its picture has not begun yet");
  }
  writer_.wait();
  return takeMessage();
}

std::string PictureSaver::takeMessage() {
  const std::string written = writer_.takeMessage();
  return written.empty() ? std::exchange(message_, {}) : written;
}

void PictureSaver::write(picture::Picture picture, const std::string& note) {
  writer_.begin(std::move(picture), std::exchange(path_, {}), channels_,
                viewer_.pilot.falseColour(), note);
}

} // namespace vv
