#include "backend/cluster/worker/exchange.h"

#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "backend/cluster/net/addresses.h"
#include "backend/cluster/worker/array_cache.h"
#include "keep_running.h"
#include "steady_clock.h"

namespace openrt::cluster {
namespace {

constexpr size_t mostAsking = 256; // workers that are sent arrays at once
constexpr double unused = 2;       // seconds after which a connection without work is closed
// Seconds to wait for messages; `hurry` while no queue takes another piece.
constexpr double idle = 0.05, hurry = 0.002;

} // namespace

struct Exchange::Impl {
  struct Source { // a worker that is asked
    std::string address;
    bool connected = false;
    std::map<Hash, ArrayStream> arrays; // those that are still to come
    double lastPiece = 0;               // or the last question
  };
  struct Sending { // an array on its way to a worker that has asked
    Hash hash;
    uint64_t bytes = 0;
    ArrayFolder::Stored stored; // open from the first piece on
    uint64_t offset = 0;
    Frames piece; // a piece that was made when the queue turned out to be full
  };
  struct Order {
    std::string address;
    std::vector<message::ArrayName> arrays;
  };

  Impl(const ExchangeOptions& o, ArrayFolder& f, WorkerCounts& c)
      : options(o), folder(f), counts(c), wire(wireOptions(o)),
        port(Address::parse(wire.address()).port) {
    thread = std::thread([this] { run(); });
  }
  ~Impl() {
    stopping = true;
    wire.wake();
    thread.join();
  }

  // A worker that loads its processor for seconds is not lost: the arrays come a little later.
  static WireOptions wireOptions(const ExchangeOptions& o) {
    WireOptions w;
    w.listen = o.listen;
    w.keys = o.keys;
    w.heartbeat = 0.5;
    w.silence = o.patience;
    return w;
  }

  void run() {
    keepRunning([this] { return stopping.load(); },
                [this] {
                  takeOrders();
                  sendQuestions();
                  take(wire.receive(sendPieces()));
                  checkSources(steadySeconds());
                },
                [this] { // no memory, perhaps for a while
                  sending.clear();
                  while (!sources.empty()) drop(sources.begin()->first);
                });
  }

  // The worker that asks.

  void takeOrders() {
    std::vector<Order> taken;
    {
      const std::lock_guard lock(mutex);
      taken.swap(orders);
    }
    for (Order& order : taken) {
      try {
        ask(order);
      } catch (const std::exception&) { // the address cannot be called
        for (const message::ArrayName& name : order.arrays) fail(name.hash);
      }
    }
  }

  Source& sourceAt(const std::string& address, Peer& peer) {
    for (auto& [number, source] : sources)
      if (source.address == address) {
        peer = number;
        return source;
      }
    // Only what other machines can be is called: no local socket of another program.
    if (Address::parse(address).ipc) throw std::runtime_error("a local socket");
    peer = wire.call(address);
    Source& source = sources[peer];
    source.address = address;
    return source;
  }

  void ask(const Order& order) {
    Peer peer = 0;
    Source& source = sourceAt(order.address, peer);
    if (source.arrays.empty()) source.lastPiece = steadySeconds();
    message::Fetch fetch;
    for (const message::ArrayName& name : order.arrays)
      if (!isAsked(name.hash) &&
          source.arrays.try_emplace(name.hash, name.hash, name.bytes, &folder).second)
        fetch.arrays.push_back(name);
    if (fetch.arrays.empty()) return;
    unsent[peer].push_back(encode(0, std::move(fetch)));
  }

  bool isAsked(const Hash& hash) const {
    for (const auto& [peer, source] : sources)
      if (source.arrays.contains(hash)) return true;
    return false;
  }

  void fail(const Hash& hash) {
    counts.failedFetches++;
    options.done(hash, nullptr);
  }

  void sendQuestions() {
    for (auto& [peer, messages] : unsent) {
      const auto source = sources.find(peer);
      if (source == sources.end() || !source->second.connected) continue;
      while (!messages.empty() && wire.send(peer, std::move(messages.front())))
        messages.pop_front();
    }
    std::erase_if(unsent, [](const auto& entry) { return entry.second.empty(); });
  }

  // Forgets a worker that was asked. Arrays that it has not sent must come from somebody else.
  void drop(Peer peer) {
    unsent.erase(peer);
    const auto found = sources.find(peer);
    if (found == sources.end()) return;
    const Source source = std::move(found->second);
    sources.erase(found);
    if (!source.connected) abandoned.insert(peer);
    for (const auto& [hash, stream] : source.arrays) fail(hash);
  }

  void piece(Peer peer, const message::Piece& m) {
    const auto found = sources.find(peer);
    if (found == sources.end()) return wire.bad(peer, "a piece was not asked for");
    Source& source = found->second;
    const auto stream = source.arrays.find(m.hash);
    if (stream == source.arrays.end()) return wire.bad(peer, "a piece was not asked for");
    source.lastPiece = steadySeconds();
    std::string why;
    try {
      why = stream->second.put(m);
    } catch (const std::bad_alloc&) { why = "no memory"; }
    if (why.empty() && !stream->second.complete()) return;
    const ArrayPtr array = why.empty() ? stream->second.take() : nullptr;
    if (!array) { // it has other bytes than it should; so may the rest
      wire.close(peer, "an array is damaged");
      return drop(peer);
    }
    source.arrays.erase(stream);
    options.done(m.hash, array);
  }

  void checkSources(double now) {
    std::vector<Peer> over;
    for (const auto& [peer, source] : sources)
      if (now - source.lastPiece > (source.arrays.empty() ? unused : options.patience))
        over.push_back(peer);
    for (Peer peer : over) {
      wire.close(peer, "this worker needs no more");
      drop(peer);
    }
  }

  // The worker that is asked.

  void fetchFor(Peer peer, const message::Fetch& m) {
    if (sources.contains(peer)) return wire.bad(peer, "it was asked and asks itself");
    if (!sending.contains(peer) && sending.size() >= mostAsking)
      return wire.close(peer, "this worker sends to too many others");
    if (m.arrays.empty()) return;
    std::deque<Sending>& queue = sending[peer];
    if (queue.size() + m.arrays.size() > limits::arraysAsked)
      return endSending(peer, "it asks for too many arrays");
    for (const message::ArrayName& name : m.arrays) {
      Sending& one = queue.emplace_back();
      one.hash = name.hash;
      one.bytes = name.bytes;
    }
  }

  void endSending(Peer peer, const std::string& why) {
    wire.close(peer, why);
    sending.erase(peer);
  }

  // Sends a piece to each worker in turn. Returns the seconds to wait until the next turn.
  double sendPieces() {
    std::vector<Peer> lacking; // workers that ask for an array that the folder no longer has
    bool sent = false;
    for (auto& [peer, queue] : sending) {
      Sending& next = queue.front();
      if (next.piece.empty() && !makePiece(next)) {
        lacking.push_back(peer);
        continue;
      }
      const size_t bytes = bytesOf(next.piece);
      if (!wire.send(peer, std::move(next.piece))) continue;
      sent = true;
      counts.toWorkers += bytes;
      next.piece.clear();
      next.offset += pieceBytes;
      if (next.offset >= next.stored.stored) queue.pop_front();
    }
    for (Peer peer : lacking) endSending(peer, "this worker no longer has the array");
    std::erase_if(sending, [](const auto& entry) { return entry.second.empty(); });
    return sending.empty() ? idle : sent ? 0 : hurry;
  }

  // Reads the next piece of an array. Returns false if the folder no longer has it.
  bool makePiece(Sending& next) {
    if (!next.stored.file) {
      std::optional<ArrayFolder::Stored> found = folder.open(next.hash, next.bytes);
      if (!found) return false;
      next.stored = std::move(*found);
    }
    message::Piece m;
    m.hash = next.hash;
    m.bytes = next.bytes;
    m.stored = next.stored.stored;
    m.offset = next.offset;
    if (!next.stored.read(next.offset, m.data)) {
      folder.discard(next.hash);
      return false;
    }
    next.piece = encode(0, std::move(m));
    return true;
  }

  // Both.

  void take(Event&& event) {
    const Peer peer = event.peer;
    switch (event.kind) {
    case Event::Kind::joined:
      if (const auto found = sources.find(peer); found != sources.end())
        found->second.connected = true;
      if (abandoned.erase(peer)) wire.close(peer, "this worker needs no more");
      return;
    case Event::Kind::left:
      abandoned.erase(peer);
      sending.erase(peer);
      return drop(peer);
    case Event::Kind::message: break;
    default: return;
    }
    counts.fromWorkers += bytesOf(event.frames);
    Message m;
    if (const std::string why = decode(std::move(event.frames), m); !why.empty())
      return wire.bad(peer, why);
    if (const auto* sent = std::get_if<message::Piece>(&m.body)) return piece(peer, *sent);
    if (const auto* asked = std::get_if<message::Fetch>(&m.body)) return fetchFor(peer, *asked);
    if (!std::holds_alternative<message::Unknown>(m.body))
      wire.bad(peer, "workers do not send this message to each other");
  }

  ExchangeOptions options;
  ArrayFolder& folder;
  WorkerCounts& counts;
  std::mutex mutex; // guards orders
  std::vector<Order> orders;
  std::atomic<bool> stopping{false};
  // The exchange's thread.
  std::map<Peer, Source> sources;
  std::set<Peer> abandoned; // calls that nobody waits for; they end when they are answered
  std::map<Peer, std::deque<Frames>> unsent; // questions
  std::map<Peer, std::deque<Sending>> sending;
  Wire wire;
  const uint16_t port; // at which it listens
  std::thread thread;
};

Exchange::Exchange(const ExchangeOptions& options, ArrayFolder& folder, WorkerCounts& counts)
    : impl_(std::make_unique<Impl>(options, folder, counts)) {}
Exchange::~Exchange() = default;

uint16_t Exchange::port() const { return impl_->port; }

void Exchange::fetch(const std::string& address, std::vector<message::ArrayName> arrays) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->orders.push_back({address, std::move(arrays)});
  }
  impl_->wire.wake();
}

} // namespace openrt::cluster
