#include "control/pictures_sent.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <new>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base64.h"
#include "libpicture/files/atomic_file.h"

namespace vv::control {

namespace {

std::atomic<int> threads{0}; // that encode

Encoded encoded(const picture::Picture& picture, uint32_t channels, const Render& render) {
  try {
    const picture::Format& format = formatOf(render);
    const std::string bytes = format.encode(picture::withChannels(picture, channels));
    const std::string facts =
        fmt::format(R"("format":{},"width":{},"height":{})", jsonText(format.suffixes[0]),
                    picture.width, picture.height);
    if (render.file.empty())
      return {fmt::format(R"({{{},"data":"{}"}})", facts, base64Of(bytes)), ""};
    picture::writeRegularFile(render.file, bytes);
    return {fmt::format(R"({{{},"file":{}}})", facts, jsonText(render.file)), ""};
  } catch (const std::bad_alloc&) {
    return {"", "not enough memory for the picture"};
  } catch (const std::exception& error) { return {"", error.what()}; }
}

} // namespace

const picture::Format& formatOf(const Render& render) {
  const picture::Format* format = !render.format.empty() ? picture::formatNamed(render.format)
                                  : render.file.empty()  ? picture::formatNamed("png")
                                                         : picture::formatOf(render.file);
  if (format) return *format;
  throw CommandError("command",
                     fmt::format("render: {}: one of {} was expected, not {}",
                                 render.format.empty() ? "file: a suffix of a format" : "format",
                                 picture::formatSuffixes(),
                                 shownJson(render.format.empty() ? render.file : render.format)));
}

uint32_t channelsOf(const Render& render, uint32_t usual) {
  if (render.channels.empty()) return usual;
  uint32_t channels = 0;
  for (const std::string& name : render.channels) {
    const picture::Channel* channel = picture::findChannel(name);
    if (!channel) {
      std::string known;
      for (const picture::Channel& one : picture::channelTable())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", one.name);
      throw CommandError("command", fmt::format("render: channels: one of {} was expected, not {}",
                                                known, shownJson(name)));
    }
    channels |= channel->bit;
  }
  return channels;
}

struct Encoding::Task {
  picture::Picture picture;
  uint32_t channels = 0;
  Render render;
  std::promise<Encoded> answer;
  std::future<Encoded> future = answer.get_future();
};

Encoding::Encoding(picture::Picture picture, uint32_t channels, const Render& render)
    : task_(std::make_shared<Task>()) {
  task_->picture = std::move(picture);
  task_->channels = channels;
  task_->render = render;
  ++threads;
  try {
    std::thread([task = task_]() mutable {
      task->answer.set_value(encoded(task->picture, task->channels, task->render));
      task = nullptr; // frees the picture before the process may end
      --threads;
    }).detach();
  } catch (...) {
    --threads;
    throw;
  }
}

bool Encoding::hasEnded(double seconds) const {
  return task_->future.wait_for(std::chrono::duration<double>(seconds)) ==
         std::future_status::ready;
}

Encoded Encoding::take() { return task_->future.get(); }

bool Encoding::working() { return threads > 0; }

} // namespace vv::control
