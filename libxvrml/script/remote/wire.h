// wire.h: the messages between a browser and xvrml-script-host, coded once for both sides: a
// header, then words of 8 bytes. They carry the arguments and results of the functions of
// xscript.h: numbers, texts, typed arrays. A Reader trusts nothing: it checks sizes, counts and
// texts against the bytes received. [one thread each]
#pragma once

#include <cstdint>
#include <deque>
#include <string_view>
#include <vector>

#include "process/message.h"
#include "xvrml/xscript.h"

namespace xvrml::wire {

constexpr uint32_t version = 3;

enum class Op : uint16_t {
  // To the helper: setup first, then calls of an engine's functions, one at a time.
  setup = 1,
  create,
  initialize,
  event,
  eventsProcessed,
  shutdown,
  tick,
  destroy,
  answer, // answer to a function of the host
  // From the helper.
  ready = 20, // reply to setup
  failed,     // it cannot serve, with the reason
  done,       // the called function has returned
  host = 40   // and above: a function of the host, by its index in HostFunctions (host_functions.h)
};

const char* functionName(Op op); // returns for example "event"

enum Flags : uint16_t {
  stopped = 1, // in done: the program has used up its steps or time
  // In create: continue with initialize if create succeeds, and send a `done` for each.
  thenInitialize = 2,
};

// The element layout of each type. bytes: size of one element; 0 for texts and images.
enum class Kind : uint8_t { unknown, plain, texts, images };
struct Element {
  Kind kind;
  uint32_t bytes;
};
Element elementOf(XsType type);

// Builds a message.
class Writer {
 public:
  void begin(Op op, uint32_t script = 0, double time = 0);
  Header& header() { return *reinterpret_cast<Header*>(bytes_.data()); }

  void put(uint64_t word);
  void put(uint32_t number) { put(uint64_t(count_ = number)); }
  void put(int32_t number) { put(uint64_t(uint32_t(number))); }
  void put(double number);
  void put(const char* name); // a null text is allowed
  void put(const XsString& text);
  void put(const XsValue* value); // a null pointer and any claimed type are allowed
  void put(const XsValue& value) { put(&value); }
  void put(const XsField& field);
  void put(const XsNodeInfo& info);
  // Arrays; their length is the last uint32_t that was put.
  void put(const XsNode* nodes);
  void put(const XsString* texts);

  // Completes the message. Returns false if it is longer than allowed; it must not be sent then.
  bool finish();
  std::string_view bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  void raw(const void* data, uint64_t size);
  std::vector<char> bytes_;
  uint32_t count_ = 0;
  bool tooLong_ = false;
};

// Parses a message. Its results point into the message and into the reader.
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
  bool complete() const { return good_ && at_ == end_; } // everything has been read

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
