// kinds.h: the messages in memory, and the one table of their kinds: who may send a kind, how many
// bulk frames it has, and how it is checked. Decoding (messages_read.cpp), the variant of all
// messages, and the dispatch of master and worker follow from the table. [any]
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "backend/cluster/messages/limits.h"
#include "backend/cluster/net/wire.h"
#include "messages_generated.h"

namespace openrt::cluster {

// The messages. Most are the structs that flatc makes of the schema (HelloT and so on), with the
// fields that are there. TableType is the table of the schema.
namespace message {

struct Unknown {}; // a message of a later version; ignored

// Worker to master.
using Hello = wire::HelloT;
using Need = wire::NeedT;
struct Ready {
  using TableType = wire::Ready;
  Epoch epoch = 0;
  FrameFacts facts;
  uint8_t transport = 0; // the transport that was chosen
  RTstats stats{};
};
using Failed = wire::FailedT;
using Fault = wire::FaultT; // openrt::Fault of a shader class of the scene
struct Result {
  using TableType = wire::Result;
  Epoch epoch = 0;
  Lease lease = 0;
  double seconds = 0;
  uint64_t camera = 0, shadow = 0, secondary = 0; // rays traced
  std::vector<Fault> faults;
  std::vector<std::byte> bytes; // output of encodeResult; empty before unpack()
  struct Packed {               // the frames as received
    Frames frames;
    uint64_t bytes = 0, hash = 0;
    bool lz4 = false;
  } packed{};
};
using Log = wire::LogT;
using Got = wire::GotT;

// Master to worker.
using Welcome = wire::WelcomeT;
using Library = wire::LibraryT; // bare name, like that of a plug-in; content hash of its file
struct Scene {
  using TableType = wire::Scene;
  Epoch epoch = 0;
  bool whole = false, prepare = false; // parameters of WorkerCore::scene()
  std::vector<ArrayName> arrays;       // arrays that the commit adds
  std::vector<Library> libraries;      // libraries that the commit adds
  std::vector<std::byte> edits;        // output of packEdits (backend/record/edits_bytes.h)
};
// bytes: size of the array; stored: its size as packed by packArray; offset: into the packed bytes.
struct Piece : wire::PieceT {
  std::vector<std::byte> data;
};
using Prepare = wire::PrepareT;
using Jobs = wire::JobsT;
using Drop = wire::DropT;
using Source = wire::SourceT;

// Worker to worker, beside Piece.
using Fetch = wire::FetchT;

// Both directions. Handled inside the Wire.
using Beat = wire::BeatT;
using Bye = wire::ByeT;

} // namespace message

// sharer: a worker that asks another one for arrays (worker/exchange.h).
enum class Sender : uint8_t { worker, master, both, sharer };

// Size class of a message: how many bulk frames it has.
struct BulkFrames {
  size_t least, most;
};
inline constexpr BulkFrames noBulk{0, 0}, oneFrame{1, 1}, manyFrames{1, limits::frames - 1};

// The checks of a message; checkBody() runs the one that the row of its kind names. A check throws
// BadMessage with the reason. Texts need no check of their length, because Text cuts them.

// Accepts any numbers: those that receive the message compare them with what they know.
struct Unchecked {
  static void check(const auto&, const Frames&) {}
};

// Throws if an array of structs does not lie at a multiple of their alignment, at which they are
// read. The verifier of flatbuffers checks only the array's length.
template <class T> void demandAligned(const flatbuffers::Vector<const T*>* array) {
  demand(!array || reinterpret_cast<uintptr_t>(array->Data()) % alignof(T) == 0,
         "an array is not aligned");
}

// Accepts a message if the array of structs that `field` returns is aligned.
template <auto field> struct Aligned {
  static void check(const auto& m, const Frames&) { demandAligned((m.*field)()); }
};

// Stands for a function of checks.cpp, which needs no declaration here.
struct ByFunction {};

// A text as a template argument.
template <size_t size> struct Literal {
  char text[size];
  consteval Literal(const char (&from)[size]) { std::copy_n(from, size, text); }
};

// Accepts a message if the number that `field` returns lies in a range. NaN lies in none.
template <auto field, int64_t least, int64_t most, Literal why> struct Within {
  static void check(const auto& m, const Frames&) {
    const auto value = double((m.*field)());
    demand(value >= double(least) && value <= double(most), why.text);
  }
};

template <class M, Sender from, BulkFrames frames, class C> struct MessageKind {
  using Message = M;
  using Table = typename M::TableType;
  using Check = C;
  static constexpr wire::Any any = wire::AnyTraits<Table>::enum_value; // has its name, too
  static constexpr Sender sender = from;
  static constexpr BulkFrames bulk = frames;
};

// The table, in the order of the union in messages.fbs.
// clang-format off
using Kinds = std::tuple<
    //          message           sent by         bulk frames check
    MessageKind<message::Hello,   Sender::worker, noBulk,     Within<
        &wire::Hello::threads, 1, 65536, "an impossible number of threads">>,
    MessageKind<message::Need,    Sender::worker, noBulk,     Aligned<&wire::Need::arrays>>,
    MessageKind<message::Ready,   Sender::worker, noBulk,     ByFunction>,
    MessageKind<message::Failed,  Sender::worker, noBulk,     Unchecked>,
    MessageKind<message::Result,  Sender::worker, manyFrames, ByFunction>,
    MessageKind<message::Log,     Sender::worker, noBulk,     Unchecked>,
    MessageKind<message::Welcome, Sender::master, noBulk,     ByFunction>,
    MessageKind<message::Scene,   Sender::master, manyFrames, ByFunction>,
    MessageKind<message::Piece,   Sender::master, oneFrame,   ByFunction>,
    MessageKind<message::Prepare, Sender::master, noBulk,     Unchecked>,
    MessageKind<message::Jobs,    Sender::master, noBulk,     ByFunction>,
    MessageKind<message::Drop,    Sender::master, noBulk,     Unchecked>,
    MessageKind<message::Beat,    Sender::both,   noBulk,     Unchecked>,
    MessageKind<message::Bye,     Sender::both,   noBulk,     Unchecked>,
    MessageKind<message::Got,     Sender::worker, noBulk,     Aligned<&wire::Got::arrays>>,
    MessageKind<message::Source,  Sender::master, noBulk,     ByFunction>,
    MessageKind<message::Fetch,   Sender::sharer, noBulk,     ByFunction>>;
// clang-format on

// Calls f with each row of the table.
template <class F> constexpr void forEachKind(F&& f) {
  [&]<class... Row>(const std::tuple<Row...>*) {
    (f(Row()), ...);
  }(static_cast<const Kinds*>(nullptr));
}

// Returns true if the rows are all members of the union, in its order.
constexpr bool kindsAreThoseOfTheSchema() {
  size_t row = 0;
  bool same = true;
  forEachKind([&](auto kind) { same = same && size_t(kind.any) == ++row; });
  return same && row == size_t(wire::Any::MAX);
}
static_assert(kindsAreThoseOfTheSchema());

// Checks the body of a message before anything of it is copied. Throws BadMessage with the reason.
// Unknown kinds pass.
void checkBody(const wire::Header& header, const Frames& frames);

namespace message {

template <class Rows> struct BodyOf;
template <class... Row> struct BodyOf<std::tuple<Row...>> {
  using Type = std::variant<Unknown, typename Row::Message...>;
};
using Body = BodyOf<Kinds>::Type; // its index is the number of the union's member

} // namespace message

// Hands a message to the handler's function for its kind. Returns false if the kind is not for the
// peer to send; `peer` says what the peer is. The handler needs a function for each kind that only
// such a peer sends. Kinds that both send, and unknown ones, are for nobody.
template <Sender peer, class Handler> bool dispatch(message::Body& body, const Handler& handler) {
  bool allowed = true;
  forEachKind([&](auto kind) {
    auto* m = std::get_if<typename decltype(kind)::Message>(&body);
    if (!m) return;
    if constexpr (kind.sender == peer)
      handler(*m);
    else
      allowed = kind.sender == Sender::both;
  });
  return allowed;
}

} // namespace openrt::cluster
