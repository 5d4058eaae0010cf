// xvrml_script_wire.cpp: the messages between the browser and xvrml-script-host. Values survive
// encoding and decoding. Invalid messages from a helper end the helper with a message and have no
// other effect.
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "script/looking_host.h"
#include "xvrml/xscript_types.h"

namespace xvrml {
namespace {

using namespace wire;

Message messageOf(Writer& writer) {
  EXPECT_TRUE(writer.finish());
  Message message;
  message.header = writer.header();
  const std::string_view bytes = writer.bytes().substr(sizeof(Header));
  message.bytes.assign(bytes.begin(), bytes.end());
  return message;
}

XsValue valueOf(XsType type, uint32_t count, const void* data) {
  XsValue value{type, count, {nullptr}};
  value.of.data = data;
  return value;
}

TEST(ScriptWire, EveryTypeComesOutAsItWentIn) {
  const std::vector<double> numbers(64, 1.5);
  for (int type = XS_SFBOOL; type <= XS_LAST_TYPE; ++type) {
    const Element element = elementOf(XsType(type));
    if (element.kind != Kind::plain) continue;
    for (const uint32_t count : {0u, 1u, 3u}) {
      const XsValue value = valueOf(XsType(type), count, numbers.data());
      Writer writer;
      writer.begin(Op::event, 7, 2.5);
      writer.put(value);
      const Message message = messageOf(writer);
      EXPECT_EQ(message.header.script, 7u);
      EXPECT_EQ(message.header.time, 2.5);
      Reader reader(message);
      const auto* out = reader.take<const XsValue*>();
      ASSERT_TRUE(out && reader.complete()) << type;
      EXPECT_EQ(out->type, type);
      ASSERT_EQ(out->count, count);
      if (count > 0) {
        EXPECT_EQ(std::memcmp(out->of.data, numbers.data(), count * element.bytes), 0);
      }
    }
  }
}

TEST(ScriptWire, TextsAndImagesComeOutAsTheyWentIn) {
  std::vector<std::string> texts;
  for (size_t length = 0; length < 20; ++length) texts.emplace_back(length, 'x');
  texts.emplace_back("a\0b", 3);
  std::vector<XsString> list;
  for (const std::string& text : texts) list.push_back({text.data(), text.size()});
  const uint8_t pixels[] = {1, 2, 3, 4, 5, 6};
  const XsImage images[] = {
      {2, 1, 3, 0, pixels}, {0, 0, 0, 0, nullptr}, {5, 5, 0, 0, pixels}, {-1, 2, 9, 0, pixels}};
  Writer writer;
  writer.begin(Op::event);
  writer.put(valueOf(XS_MFSTRING, uint32_t(list.size()), list.data()));
  writer.put(valueOf(XS_SFIMAGE, 4, images));
  const Message message = messageOf(writer);
  Reader reader(message);
  const auto* strings = reader.take<const XsValue*>();
  const auto* pictures = reader.take<const XsValue*>();
  ASSERT_TRUE(strings && pictures && reader.complete());
  for (size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(std::string(strings->of.strings[i].data, strings->of.strings[i].bytes), texts[i]);
    EXPECT_EQ(strings->of.strings[i].data[texts[i].size()], 0);
  }
  EXPECT_EQ(std::memcmp(pictures->of.images[0].pixels, pixels, 6), 0);
  EXPECT_EQ(pictures->of.images[1].pixels, nullptr);
  EXPECT_EQ(pictures->of.images[3].width, -1); // refused by the code that reads it as a value
}

TEST(ScriptWire, WhatIsNoGoodValueGoesAcrossAsSuch) {
  const XsString noText{nullptr, 5};
  Writer writer;
  writer.begin(Op::event);
  writer.put(static_cast<const XsValue*>(nullptr));
  writer.put(static_cast<const char*>(nullptr));
  writer.put(noText);
  writer.put(valueOf(XS_MFSTRING, 3, nullptr));
  writer.put(valueOf(XsType(77), 3, &noText));
  const Message message = messageOf(writer);
  Reader reader(message);
  EXPECT_EQ(reader.take<const XsValue*>(), nullptr);
  EXPECT_EQ(reader.take<const char*>(), nullptr);
  EXPECT_EQ(reader.take<XsString>().bytes, 5u);
  const auto* strings = reader.take<const XsValue*>();
  const auto* unknown = reader.take<const XsValue*>();
  ASSERT_TRUE(strings && unknown && reader.complete());
  EXPECT_EQ(strings->count, 3u);
  EXPECT_EQ(strings->of.data, nullptr);
  EXPECT_EQ(unknown->type, 77);
  EXPECT_EQ(unknown->of.data, nullptr);
}

TEST(ScriptWire, AMessageThatIsTooLongIsNone) {
  Writer writer;
  writer.begin(Op::event);
  writer.put(valueOf(XS_MFVEC3F, UINT32_MAX, &writer)); // never read
  EXPECT_FALSE(writer.finish());
  writer.begin(Op::event);
  EXPECT_TRUE(writer.finish());
}

// --- A hostile helper ---

std::string wireOf(Writer& writer) {
  EXPECT_TRUE(writer.finish());
  return std::string(writer.bytes());
}

std::vector<std::string> goodMessages() {
  std::vector<std::string> all;
  const XsString texts[] = {{"one", 3}, {"two", 3}};
  const float numbers[] = {1, 2, 3, 4, 5, 6};
  const uint8_t pixels[] = {1, 2, 3, 4};
  const XsImage image{2, 2, 1, 0, pixels};
  Writer w;
  const auto function = [&](int number) {
    w.begin(Op::host, 1);
    w.header().op = uint16_t(int(Op::host) + number);
    w.put(uint64_t(1));
  };
  for (const XsValue& value : {valueOf(XS_MFSTRING, 2, texts), valueOf(XS_MFVEC3F, 2, numbers),
                               valueOf(XS_SFIMAGE, 1, &image)}) {
    function(0);
    w.put("out");
    w.put(value);
    all.push_back(wireOf(w));
  }
  function(16); // loadUrl
  w.put(2u);
  w.put(&texts[0]);
  w.put(1u);
  w.put(&texts[0]);
  all.push_back(wireOf(w));
  function(21); // log
  w.put(int32_t(0));
  w.put(1u);
  w.put(texts[0]);
  all.push_back(wireOf(w));
  w.begin(Op::done, 1);
  all.push_back(wireOf(w));
  return all;
}

TEST(ScriptWire, AGoodHelperIsServed) {
  std::string bytes;
  for (const std::string& message : goodMessages()) bytes += message;
  EXPECT_EQ(callThatGets(bytes), ScriptProcess::State::returned);
}

TEST(ScriptWire, BadMessagesEndTheHelper) {
  std::string death;
  Writer w;
  const auto bad = [&] { return callThatGets(wireOf(w), &death); };
  // No operation, one of the browser's own, and values beyond the last.
  for (const uint16_t op : {0, 1, 7, 20, 62, 40000}) {
    w.begin(Op(op), 1);
    EXPECT_EQ(bad(), ScriptProcess::State::died) << op;
    EXPECT_EQ(death, "broke the protocol");
  }
  w.begin(Op::host); // send without arguments
  EXPECT_EQ(bad(), ScriptProcess::State::died);
  w.begin(Op::done);
  w.put(uint64_t(1)); // more bytes than the message has
  EXPECT_EQ(bad(), ScriptProcess::State::died);
  std::string length = goodMessages()[0];
  length[3] = 0x7f;
  EXPECT_EQ(callThatGets(length, &death), ScriptProcess::State::died);
  EXPECT_EQ(death, "sent a message that is too long");
  EXPECT_EQ(callThatGets("", &death), ScriptProcess::State::died);
  w.begin(Op::done);
  w.header().result = 12345;
  EXPECT_EQ(bad(), ScriptProcess::State::returned); // handled as XS_FAILED
}

// Good messages with bytes changed, removed and repeated, and random bytes.
TEST(ScriptWire, WhateverAHelperSaysNothingBreaks) {
  std::mt19937 random(1);
  const std::vector<std::string> good = goodMessages();
  int returned = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string bytes;
    for (size_t k = random() % 4 + 1; k > 0; --k) bytes += good[random() % good.size()];
    for (size_t k = random() % 6; k > 0; --k) {
      const size_t at = random() % bytes.size();
      switch (random() % 5) {
      case 0: bytes[at] = char(random()); break;
      case 1: bytes[at] = char(1 << random() % 8 ^ bytes[at]); break;
      case 2: bytes[at / 8 * 8] = char(random() % 64); break; // a number or a length
      case 3: bytes.resize(at + 1); break;
      case 4:
        std::memset(bytes.data() + at, round % 2 ? 0xff : 0,
                    std::min<size_t>(8, bytes.size() - at));
        break;
      }
    }
    if (round % 10 == 0)
      for (char& byte : bytes) byte = char(random());
    const auto state = callThatGets(bytes);
    EXPECT_NE(state, ScriptProcess::State::running);
    returned += state == ScriptProcess::State::returned;
  }
  EXPECT_GT(returned, 100);
}

} // namespace
} // namespace xvrml
