// wire.h: the messages between a browser and xvrml-script-host, coded once for both: a header, then
// words of 8 bytes. What goes across is what the functions of xscript.h take and give: numbers,
// texts, typed arrays. A Reader believes nothing: sizes, counts and texts are checked against what
// has arrived. [one thread each]
#pragma once

#include <cstdint>
#include <deque>
#include <string_view>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml::wire {

constexpr uint32_t version = 2;
constexpr uint32_t maximumMessage = 256u << 20; // bytes of one message

enum class Op : uint16_t {
  // to the helper: what the browser says before anything else, then calls of an engine's functions,
  // one at a time
  setup = 1,
  create,
  initialize,
  event,
  eventsProcessed,
  shutdown,
  tick,
  destroy,
  answer, // to a function of the host
  // from the helper
  ready = 20, // after setup
  failed,     // it cannot serve; why
  done,       // the function that was called has returned
  host = 40 // and upwards: a function of the host, by its place in HostFunctions (host_functions.h)
};

const char* functionName(Op op); // "event"

enum Flags : uint16_t {
  stopped = 1,        // of done: the program has used up its steps or its time
  thenInitialize = 2, // of create: the helper goes on with initialize if create succeeds, and
                      // answers each with a `done`
};

struct Header {
  uint32_t bytes; // of what follows
  uint16_t op, flags;
  uint32_t script; // the interpreter's number in its process
  int32_t result;  // XsResult of done and answer
  double time;     // to the helper: the timestamp
};
static_assert(sizeof(Header) == 24);

// How the elements of each type lie: bytes of one; 0 for texts, images.
enum class Kind : uint8_t { unknown, plain, texts, images };
struct Element {
  Kind kind;
  uint32_t bytes;
};
Element elementOf(XsType type);

// Puts a message together.
class Writer {
 public:
  void begin(Op op, uint32_t script = 0, double time = 0);
  Header& header() { return *reinterpret_cast<Header*>(bytes_.data()); }

  void put(uint64_t word);
  void put(uint32_t number) { put(uint64_t(count_ = number)); }
  void put(int32_t number) { put(uint64_t(uint32_t(number))); }
  void put(double number);
  void put(const char* name); // may be null
  void put(const XsString& text);
  void put(const XsValue* value); // may be null, and of any type that is claimed
  void put(const XsValue& value) { put(&value); }
  void put(const XsField& field);
  void put(const XsNodeInfo& info);
  // Arrays, as long as the uint32_t that was put before them says.
  void put(const XsNode* nodes);
  void put(const XsString* texts);

  // The whole message. False if it is longer than messages may be: then it is nothing.
  bool finish();
  std::string_view bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  void raw(const void* data, uint64_t size);
  std::vector<char> bytes_;
  uint32_t count_ = 0;
  bool tooLong_ = false;
};

// A message that has arrived.
struct Message {
  Header header{};
  std::vector<char> bytes; // begins at an address that any element can have
};

// Takes it apart. What it gives points into the message and into the reader.
class Reader {
 public:
  explicit Reader(const Message& message)
      : at_(message.bytes.data()), end_(at_ + message.bytes.size()) {}

  void get(uint64_t& word);
  void get(uint32_t& number);
  void get(int32_t& number);
  void get(double& number);
  void get(const char*& name);
  void get(XsString& text);
  void get(const XsValue*& value);
  void get(XsValue& value);
  void get(XsField& field);
  void get(XsNodeInfo& info);
  void get(const XsNode*& nodes);
  void get(const XsString*& texts);
  template <class T> T take() {
    T value{};
    get(value);
    return value;
  }

  bool good() const { return good_; }
  bool complete() const { return good_ && at_ == end_; } // all of it has been used

 private:
  const char* raw(uint64_t size);
  const XsString* strings(uint64_t count);
  const char* at_;
  const char* end_;
  bool good_ = true;
  uint32_t count_ = 0;
  std::deque<std::vector<XsString>> strings_;
  std::deque<std::vector<XsImage>> images_;
  std::deque<XsValue> values_;
};

} // namespace xvrml::wire
