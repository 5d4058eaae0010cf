// server_message.cpp: Tests the reader of the messages of a page: what it accepts, and that it
// refuses everything else with a reason.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "server/limits.h"
#include "server/message.h"

namespace vv::server {
namespace {

using Type = Message::Type;
using Kind = InputEvent::Kind;

Message accepted(const std::string& text) {
  const ReadMessage read = readMessage(text);
  EXPECT_TRUE(read.message) << text << ": " << read.fault;
  return read.message.value_or(Message{});
}

std::string faultOf(const std::string& text) {
  const ReadMessage read = readMessage(text);
  EXPECT_FALSE(read.message) << text;
  return read.fault;
}

TEST(ServerMessage, ReadsEveryType) {
  const Message size = accepted(R"({"type":"size","width":1600,"height":900})");
  EXPECT_EQ(size.type, Type::size);
  EXPECT_EQ(size.width, 1600);
  EXPECT_EQ(size.height, 900);
  EXPECT_EQ(accepted(R"({"type":"shown","picture":4294967295})").picture, 4294967295u);
  EXPECT_EQ(accepted(R"({"number":2,"type":"viewpoint"})").number, 2);
  EXPECT_EQ(accepted(R"({"type":"own"})").type, Type::own);
  EXPECT_EQ(accepted(R"({"type":"follow"})").type, Type::follow);
  EXPECT_EQ(accepted(R"({"type":"command"})").type, Type::command);
  EXPECT_EQ(accepted(R"({"type":"save","format":"png"})").format, Message::Format::png);
  EXPECT_EQ(accepted(R"({"type":"save","format":"exr"})").format, Message::Format::exr);
}

TEST(ServerMessage, ReadsInput) {
  const Message move = accepted(R"({"type":"move","x":-0.25,"y":1})");
  EXPECT_EQ(move.type, Type::input);
  EXPECT_EQ(move.input.kind, Kind::move);
  EXPECT_EQ(move.input.x, -0.25);
  EXPECT_EQ(move.input.y, 1);
  const InputEvent press =
      accepted(R"({"type":"press","button":"right","x":0,"y":0.5,"shift":true,"ctrl":false})")
          .input;
  EXPECT_EQ(press.kind, Kind::press);
  EXPECT_EQ(press.button, Button::right);
  EXPECT_TRUE(press.shift);
  EXPECT_FALSE(press.control || press.alt);
  EXPECT_EQ(accepted(R"({"type":"release","button":"middle","x":0,"y":0})").input.button,
            Button::middle);
  EXPECT_EQ(accepted(R"({"type":"leave"})").input.kind, Kind::leave);
  EXPECT_EQ(accepted(R"({"type":"wheel","amount":-2.5})").input.amount, -2.5);
  const InputEvent down = accepted(R"({"type":"down","key":"PageDown","alt":true})").input;
  EXPECT_EQ(down.kind, Kind::down);
  EXPECT_EQ(down.text, "PageDown");
  EXPECT_TRUE(down.alt);
  EXPECT_EQ(accepted(R"({"type":"up","key":"["})").input.kind, Kind::up);
}

TEST(ServerMessage, RefusesWhatIsNoFlatObject) {
  EXPECT_EQ(faultOf(""), "it is no JSON");
  EXPECT_EQ(faultOf("{\"type\":\"leave\"} x"), "it is no JSON");
  EXPECT_EQ(faultOf("{\"type\":\"leave\""), "it is no JSON");
  EXPECT_EQ(faultOf("{\"type\":\"down\",\"key\":\"\xff\"}"), "it is no JSON");
  EXPECT_EQ(faultOf("7"), "an object was expected");
  EXPECT_EQ(faultOf("[1]"), "a plain value was expected, not an array");
  EXPECT_EQ(faultOf(R"({"type":{"a":1}})"), "a plain value was expected, not an object");
  EXPECT_EQ(faultOf(R"({"type":"leave","type":"leave"})"), "a name occurs twice");
  EXPECT_EQ(faultOf(std::string(2000, '[')), "a plain value was expected, not an array");
}

TEST(ServerMessage, RefusesUnknownMissingAndSuperfluousMembers) {
  EXPECT_EQ(faultOf("{}"), "type: it is missing");
  EXPECT_TRUE(faultOf(R"({"type":"quit"})").starts_with("type: one of size, shown, move"));
  EXPECT_EQ(faultOf(R"({"type":7})"), "type: a text was expected");
  EXPECT_EQ(faultOf(R"({"type":"size","width":3})"), "height: it is missing");
  EXPECT_EQ(faultOf(R"({"type":"leave","x":0})"), "there are more members than its type has");
  EXPECT_EQ(faultOf(R"({"type":"press","button":"side","x":0,"y":0})"),
            "button: one of left, middle, right was expected");
  EXPECT_EQ(faultOf(R"({"type":"press","button":"left","x":0,"y":0,"shift":1})"),
            "shift: true or false was expected");
}

TEST(ServerMessage, RefusesNumbersOutOfRange) {
  EXPECT_EQ(faultOf(R"({"type":"size","width":0,"height":1})"),
            "width: a number from 1 to 65536 was expected");
  EXPECT_EQ(faultOf(R"({"type":"size","width":2.5,"height":1})"),
            "width: a whole number was expected");
  EXPECT_EQ(faultOf(R"({"type":"size","width":"9","height":1})"), "width: a number was expected");
  EXPECT_EQ(faultOf(R"({"type":"shown","picture":0})").substr(0, 9), "picture: ");
  EXPECT_EQ(faultOf(R"({"type":"shown","picture":4294967296})").substr(0, 9), "picture: ");
  EXPECT_EQ(faultOf(R"({"type":"viewpoint","number":-1})").substr(0, 8), "number: ");
  EXPECT_EQ(faultOf(R"({"type":"move","x":101,"y":0})"),
            "x: a number from -100 to 100 was expected");
  EXPECT_EQ(faultOf(R"({"type":"move","x":1e999,"y":0})"), "it is no JSON");
  EXPECT_EQ(faultOf(R"({"type":"wheel","amount":-1e9})").substr(0, 8), "amount: ");
}

TEST(ServerMessage, RefusesKeysThatAreNone) {
  EXPECT_EQ(faultOf(R"({"type":"down","key":""})"), "key: 1 to 16 bytes were expected");
  EXPECT_EQ(faultOf(R"({"type":"down","key":"01234567890123456"})"),
            "key: 1 to 16 bytes were expected");
  EXPECT_EQ(faultOf(R"({"type":"down","key":"\n"})"), "key: printable ASCII was expected");
  EXPECT_EQ(faultOf("{\"type\":\"down\",\"key\":\"\xc3\xa4\"}"),
            "key: printable ASCII was expected");
}

TEST(ServerMessage, RefusesLongTexts) {
  const std::string padded = R"({"type":"leave"})" + std::string(maxMessageBytes - 16, ' ');
  EXPECT_EQ(padded.size(), size_t(maxMessageBytes));
  accepted(padded);
  EXPECT_EQ(faultOf(padded + " "),
            fmt::format("it is longer than maxMessageBytes ({})", maxMessageBytes));
}

} // namespace
} // namespace vv::server
