// saves.h: Makes files of the pictures that pages save: asks the session for them in turn, encodes
// them on a thread of its own, and tells the pages where their files are. Owned by the server.
// [main thread]
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/host.h"
#include "server/pages.h"
#include "server/reports.h"
#include "server/save_queue.h"
#include "server/served_world.h"
#include "task_threads.h"

namespace vv::server {

class Saves {
 public:
  // All of them must outlive this object. notify: shows a view a text at the bottom of its picture.
  using Notify = std::function<void(uint32_t view, const std::string& text)>;
  Saves(const Options& options, Pages& pages, ServedWorld& world, Reports& reports, Host& host,
        Notify notify)
      : options_(options), pages_(pages), world_(world), reports_(reports), host_(host),
        notify_(std::move(notify)) {}

  // A page wants its picture as a file. Does nothing while it waits for another one.
  void want(uint64_t page, Message::Format format);
  // A page does not want its picture any more.
  void giveUp(uint64_t page);
  // Begins the next picture if it is time. [while the world can be used]
  void advance();
  // The world has been replaced, and the pictures that were wanted are gone.
  void loseAll();

 private:
  double seconds() const;
  void capture(const SaveQueue::Wish& wish, const Page& page);
  void makeFile(const SaveQueue::Wish& wish, const picture::Picture& picture);
  void encode(uint64_t page, const std::string& name, const std::string& suffix,
              const picture::Picture& picture);
  void takeMadeFiles();
  void end(uint64_t page, std::string_view why = "");

  using Clock = std::chrono::steady_clock;

  const Options& options_;
  Pages& pages_;
  ServedWorld& world_;
  Reports& reports_;
  Host& host_;
  const Notify notify_;
  const Clock::time_point start_ = Clock::now();
  SaveQueue queue_;
  int begun_ = 0;    // files so far
  int inMaking_ = 0; // files that are encoded or wait for that
  std::mutex mutex_;
  std::vector<uint64_t> made_; // the pages whose files have been made since takeMadeFiles()
  TaskThreads encoder_;        // the last member: its tasks use the others
};

} // namespace vv::server
