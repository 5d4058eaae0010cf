// forwarding.h: a backend that hands every call on to another one. Those that add something to some
// calls derive from it: backend=debug:NAME and recordings. Threads as in backend.h.
#pragma once

#include <memory>
#include <utility>

#include "backend/backend.h"

namespace openrt {

class ForwardingBackend : public Backend {
 public:
  // to: never null.
  explicit ForwardingBackend(std::unique_ptr<Backend> to) : to_(std::move(to)) {}
  bool pipelines() const override { return to_->pipelines(); }
  void apply(std::shared_ptr<const Commit> commit) override { to_->apply(std::move(commit)); }
  void setPatience(double seconds) override { to_->setPatience(seconds); }
  bool keepSums(const SumsRequest& request) override { return to_->keepSums(request); }
  std::shared_ptr<FrameSums> sums() const override { return to_->sums(); }
  void start() override { to_->start(); }
  void wait() override { to_->wait(); }
  void cancel() override { to_->cancel(); }
  float progress() const override { return to_->progress(); }
  bool snapshot(RTenum channel, std::span<float> out) const override {
    return to_->snapshot(channel, out);
  }
  bool read(RTenum channel, std::span<float> out) const override { return to_->read(channel, out); }
  void stats(RTstats& stats) const override { to_->stats(stats); }
  std::vector<RTworker> workers() const override { return to_->workers(); }
  Queries* queries() override { return to_->queries(); }
  void finish() override { to_->finish(); }

 private:
  std::unique_ptr<Backend> to_;
};

} // namespace openrt
