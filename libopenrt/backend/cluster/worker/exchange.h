// exchange.h: passes arrays from worker to worker, so that the master need not send each of them to
// everybody. A worker asks those that the master names, and sends what it has in its folder
// (array_folder.h) to those that ask. All of it has one wire and one thread of its own. A worker
// that another one asks needs no more trust than any network: what arrives is checked by its hash.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backend/cluster/net/wire.h"
#include "backend/cluster/worker/array_folder.h"
#include "backend/cluster/worker/counts.h"

namespace openrt::cluster {

struct ExchangeOptions {
  std::string listen; // ADDRESS[:PORT] at which other workers may ask
  KeyRing keys;
  double patience = 5; // seconds that a worker that is asked may send nothing
  // Receives every array that was asked for, or null if it cannot be had. [the exchange's thread]
  std::function<void(const Hash&, ArrayPtr)> done;
};

class Exchange {
 public:
  // Throws std::runtime_error like Wire.
  Exchange(const ExchangeOptions& options, ArrayFolder& folder, WorkerCounts& counts);
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  uint16_t port() const; // at which it listens
  // Asks the worker at this address (HOST:PORT[=PUBLICKEY]) for arrays. [any]
  void fetch(const std::string& address, std::vector<message::ArrayName> arrays);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
