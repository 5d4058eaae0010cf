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

// Returns a command, perhaps one of a group; null: it is another one.
template <class T> const T* commandIn(const edit::Command& command) {
  return std::visit(
      [](const auto& one) -> const T* {
        using One = std::remove_cvref_t<decltype(one)>;
        if constexpr (std::is_same_v<One, T>)
          return &one;
        else if constexpr (std::is_same_v<One, edit::NodeCommand> ||
                           std::is_same_v<One, edit::ToolCommand> ||
                           std::is_same_v<One, edit::LightCommand>)
          return std::visit(
              [](const auto& inner) -> const T* {
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(inner)>, T>)
                  return &inner;
                else
                  return nullptr;
              },
              one);
        else
          return nullptr;
      },
      command);
}

template <class T> T edited(const std::string& members) {
  const ReadMessage read = readMessage(R"({"type":"edit",)" + members + "}", Rights::edit);
  EXPECT_TRUE(read.message) << members << ": " << read.fault;
  if (!read.message || !read.message->editCommand) return {};
  EXPECT_EQ(read.message->type, Type::edit);
  const T* const command = commandIn<T>(*read.message->editCommand);
  EXPECT_TRUE(command) << members;
  return command ? *command : T{};
}

std::string editFault(const std::string& members) {
  const ReadMessage read = readMessage(R"({"type":"edit",)" + members + "}", Rights::edit);
  EXPECT_FALSE(read.message) << members;
  return read.fault;
}

TEST(ServerMessage, ReadsEveryEdit) {
  EXPECT_EQ(edited<edit::ShowRows>(R"("command":"rows","first":1000000,"count":40)").first,
            1000000);
  EXPECT_EQ(edited<edit::Search>(R"("command":"search","text":"la")").text, "la");
  EXPECT_FALSE(edited<edit::Open>(R"("command":"open","node":3,"open":false)").open);
  EXPECT_FALSE(edited<edit::Select>(R"("command":"select","node":null)").node);
  EXPECT_EQ(edited<edit::Select>(R"("command":"select","node":7,"add":true)").node, 7u);
  EXPECT_TRUE(edited<edit::SelectAt>(R"("command":"select_at","x":0,"y":-1,"group":true)").group);
  const auto drag =
      edited<edit::Drag>(R"("command":"drag","node":1,"field":"point","value":[[0,1,2]])");
  EXPECT_EQ(drag.field, "point");
  EXPECT_EQ(drag.value[0][2], 2);
  EXPECT_FALSE(drag.element);
  const auto element = edited<edit::Drag>(
      R"("command":"drag","node":1,"field":"point","value":[0,1,2],"index":3,"size":4)");
  ASSERT_TRUE(element.element);
  EXPECT_EQ(element.element->index, 3u);
  EXPECT_EQ(element.element->size, 4u);
  edited<edit::EndDrag>(R"("command":"end_drag")");
  EXPECT_EQ(edited<edit::Reset>(R"("command":"reset","node":1,"field":"on")").node, 1u);
  const auto step = edited<json::edits::Step>(
      R"("command":"step","name":"Name it","edits":[{"edit":"rename","node":1,"name":"A"}])");
  EXPECT_EQ(step.name, "Name it");
  EXPECT_EQ(step.edits.size(), 1u);
  EXPECT_EQ(edited<edit::Add>(R"("command":"add","kind":"Box")").kind, "Box");
  edited<edit::Duplicate>(R"("command":"duplicate")");
  edited<edit::Remove>(R"("command":"remove")");
  edited<edit::Wrap>(R"("command":"wrap")");
  EXPECT_FALSE(edited<edit::Undo>(R"("command":"undo")").again);
  EXPECT_TRUE(edited<edit::Undo>(R"("command":"redo")").again);
  EXPECT_TRUE(edited<edit::Save>(R"("command":"save","overwrite":true)").overwrite);
  edited<edit::Revert>(R"("command":"revert")");
  EXPECT_FALSE(edited<edit::Recover>(R"("command":"recover","use":false)").use);
  EXPECT_EQ(edited<edit::PutProbe>(R"("command":"probe","x":0.5,"y":0)").place.x, 0.5);
  edited<edit::KeepProbes>(R"("command":"keep_probes")");
  edited<edit::ClearProbes>(R"("command":"clear_probes")");
  edited<edit::Close>(R"("command":"close")");
}

TEST(ServerMessage, ReadsEditsOfNodes) {
  const auto add =
      edited<edit::AddNode>(R"("command":"add_node","node":4,"field":"children","kind":"Group")");
  EXPECT_EQ(add.node, 4u);
  EXPECT_EQ(add.kind, "Group");
  EXPECT_EQ(
      edited<edit::UseNode>(R"("command":"use_node","node":4,"field":"geometry","used":5)").used,
      5u);
  const edit::At at =
      edited<edit::RemoveAt>(
          R"("command":"remove_at","node":4,"parent":2,"field":"children","index":7)")
          .at;
  EXPECT_EQ(at.parent, 2u);
  EXPECT_EQ(at.index, 7u);
  const auto move = edited<edit::MoveAt>(
      R"("command":"move_at","node":4,"parent":null,"field":"","index":7,"by":-1)");
  EXPECT_EQ(move.by, -1);
  EXPECT_FALSE(move.at.parent);
  edited<edit::SeparateAt>(
      R"("command":"separate_at","node":4,"parent":2,"field":"appearance","index":0)");
  const auto look = edited<edit::SetLook>(R"("command":"set_look","number":3,"only_here":true)");
  EXPECT_EQ(look.number, 3u);
  EXPECT_TRUE(look.onlyHere);
  EXPECT_FALSE(edited<edit::SetLook>(R"("command":"set_look","number":3)").onlyHere);
  edited<edit::SelectSameLook>(R"("command":"select_same_look")");
  EXPECT_EQ(edited<edit::AskChoices>(R"("command":"choices","node":1,"field":"a")").field, "a");
  EXPECT_TRUE(edited<edit::ShowList>(R"("command":"problems","open":true)").open);
  EXPECT_EQ(edited<edit::Hide>(R"("command":"hide_others")").what, edit::Hide::What::others);
  EXPECT_EQ(edited<edit::Hide>(R"("command":"show_all")").what, edit::Hide::What::nothing);
  edited<edit::Frame>(R"("command":"frame")");
}

TEST(ServerMessage, ReadsToolsAndLight) {
  const auto begin =
      edited<edit::BeginTool>(R"("command":"tool","kind":"turn","axis":2,"x":-99,"y":0.5)");
  EXPECT_EQ(begin.kind, edit::BeginTool::Kind::turn);
  EXPECT_EQ(begin.axis, 2);
  EXPECT_EQ(begin.place.x, -99);
  EXPECT_EQ(edited<edit::BeginTool>(R"("command":"tool","kind":"move","x":0,"y":0)").axis, -1);
  EXPECT_TRUE(edited<edit::PointTool>(R"("command":"tool_at","x":0,"y":0,"snap":true)").snap);
  EXPECT_EQ(edited<edit::TypeTool>(R"("command":"tool_key","key":"-")").key, "-");
  EXPECT_FALSE(edited<edit::EndTool>(R"("command":"end_tool","accept":false)").accept);
  edited<edit::NextHandles>(R"("command":"handles")");
  EXPECT_TRUE(
      edited<edit::PutProbe>(R"("command":"probe","x":0,"y":0,"illuminance":true)").illuminance);
  const auto measure =
      edited<edit::Measure>(R"("command":"measure","x0":-1,"y0":0,"x1":1,"y1":0.5)");
  EXPECT_EQ(measure.from.x, -1);
  EXPECT_EQ(measure.to.y, 0.5);
  EXPECT_TRUE(
      edited<edit::SelectIn>(R"("command":"select_in","x0":-1,"y0":0,"x1":1,"y1":0.5,"add":true)")
          .add);
  EXPECT_EQ(edited<edit::Compare>(R"("command":"compare","what":"difference")").what,
            edit::Compare::What::difference);
  EXPECT_EQ(edited<edit::PointAt>(R"("command":"point","x":0.25,"y":0)").place->x, 0.25);
  EXPECT_FALSE(edited<edit::PointAt>(R"("command":"point")").place) << "it rests no more";
  EXPECT_EQ(edited<edit::KeepInWorld>(R"("command":"keep_in_world","probe":2)").probe, 2);
  EXPECT_EQ(edited<edit::NameProbe>(R"("command":"name_probe","probe":2,"name":"Desk")").name,
            "Desk");
  edited<edit::ShowSensors>(R"("command":"show_sensors")");
  edited<edit::ProbeTable>(R"("command":"probe_table")");
  edited<edit::Report>(R"("command":"report")");
}

TEST(ServerMessage, RefusesEditsThatAreNone) {
  const auto has = [](const std::string& members, const std::string& part) {
    const std::string fault = editFault(members);
    EXPECT_NE(fault.find(part), std::string::npos) << members << ": " << fault;
  };
  has(R"("command":"quit")", "there is no command");
  has(R"("command":7)", "a text was expected");
  has(R"("command":"undo","name":1)", "there is no member");
  has(R"("command":"rows","first":-1,"count":3)", "from 0 to");
  has(R"("command":"rows","first":0,"count":501)", "from 0 to 500");
  has(R"("command":"rows","first":0.5,"count":1)", "a whole number");
  has(R"("command":"name_probe","probe":1,"name":")" + std::string(201, 'x') + "\"", "200 bytes");
  has(R"("command":"open","node":-1,"open":true)", "the number of a node");
  has(R"("command":"open","node":"LAMP","open":true)", "the number of a node");
  has(R"("command":"select","node":1.5)", "the number of a node");
  has(R"("command":"select_at","x":1.01,"y":0)", "from -1 to 1");
  has(R"("command":"drag","node":1,"field":"a")", "\"value\" is missing");
  has(R"("command":"drag","node":1,"field":"a","value":1,"index":0)", "\"size\" is missing");
  has(R"("command":"drag","node":1,"field":"a","value":1,"index":-1,"size":1)", "index");
  has(R"("command":"import","name":"a.stl")", "\"bytes\" is missing");
  has(R"("command":"drag","node":1,"field":"a","value":)" + std::string(9, '[') +
          std::string(9, ']'),
      "lineDepth");
  has(R"("command":"step","name":"","edits":[])", "a name");
  has(R"("command":"step","name":"x","edits":[])", "an array of objects");
  has(R"("command":"search","text":")" + std::string(257, 'a') + "\"", "at most 256 bytes");
  has(R"("command":"search","text":")" + std::string(maxEditBytes, 'a') + "\"", "lineBytes");
  has(R"("command":"undo","command":"redo")", "twice");
  has(R"("command":"remove_at","node":4,"field":"children","index":7)", "\"parent\" is missing");
  has(R"("command":"remove_at","node":4,"parent":2,"field":"children","index":-1)", "from 0 to");
  has(R"("command":"move_at","node":4,"parent":2,"field":"a","index":0,"by":2)", "from -1 to 1");
  has(R"("command":"add_node","node":4,"field":"a","kind":")" + std::string(201, 'a') + "\"",
      "at most 200 bytes");
  has(R"("command":"tool","kind":"bend","x":0,"y":0)", "one of move turn scale");
  has(R"("command":"tool","kind":"move","axis":3,"x":0,"y":0)", "from 0 to 2");
  has(R"("command":"tool","kind":"move","x":101,"y":0)", "from -100 to 100");
  has(R"("command":"tool_key","key":")" + std::string(17, '1') + "\"", "at most 16 bytes");
  has(R"("command":"measure","x0":-1.5,"y0":0,"x1":1,"y1":0)", "from -1 to 1");
  has(R"("command":"compare","what":"b")", "one of a wiper difference");
}

TEST(ServerMessage, OnlyEditorsEdit) {
  const std::string undo = R"({"type":"edit","command":"undo"})";
  EXPECT_TRUE(faultOf(undo).starts_with("type: one of "));
  EXPECT_TRUE(readMessage(undo, Rights::edit).message);
  // Their other messages are read as those of everybody.
  EXPECT_TRUE(readMessage(R"({"type":"leave"})", Rights::edit).message);
  EXPECT_FALSE(readMessage(R"({"type":"leave","x":[1]})", Rights::edit).message);
  EXPECT_FALSE(
      readMessage(R"({"type":"leave"})" + std::string(maxMessageBytes, ' '), Rights::edit).message);
}

} // namespace
} // namespace vv::server
