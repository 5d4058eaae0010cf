// control_line.cpp: Tests the reader of the control channel's lines: what is accepted, what the
// messages say, and what hostile lines cost.
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "control/command.h"

using namespace vv::control;

namespace {

Line good(const std::string& text) {
  Line line = readLine(text);
  EXPECT_TRUE(line.command) << text << ": " << line.message;
  return line;
}

// Expects an error with this code, whose message contains these words.
void bad(const std::string& text, const std::string& code, const std::string& words) {
  const Line line = readLine(text);
  EXPECT_FALSE(line.command) << text.substr(0, 200);
  EXPECT_EQ(line.code, code) << text.substr(0, 200) << ": " << line.message;
  EXPECT_NE(line.message.find(words), std::string::npos) << line.message;
}

TEST(ControlLine, LongListsTakeLinearTime) {
  std::string values;
  for (int i = 0; i < 250'000; ++i) values += R"(,{"node":"A","field":"x","value":1})";
  const auto start = std::chrono::steady_clock::now();
  const Line line = good(R"({"command":"set","values":[)" + values.substr(1) + "]}");
  EXPECT_EQ(std::get<Set>(line.command->action).values.size(), 250'000u);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(ControlLine, CommandsAreRead) {
  const Line get = good(R"({"id": 7, "command": "get", "node": "Arm", "field": "rotation"})");
  EXPECT_EQ(get.id, "7");
  EXPECT_EQ(get.command->name, "get");
  EXPECT_FALSE(get.command->quiet);
  const auto& from = std::get<Get>(get.command->action).from;
  EXPECT_EQ(std::get<std::string>(from.node), "Arm");
  EXPECT_EQ(from.field, "rotation");

  const Line set = good(
      R"({"id":"a","command":"set","node":12,"field":"rotation","value":[0,1,0,1.5],"quiet":true})");
  EXPECT_EQ(set.id, "\"a\"");
  EXPECT_TRUE(set.command->quiet);
  const auto& one = std::get<Set>(set.command->action).values.at(0);
  EXPECT_EQ(std::get<uint64_t>(one.to.node), 12u);
  EXPECT_EQ(one.value.dump(), "[0,1,0,1.5]");

  const Line many = good(R"({"command":"set","values":[{"node":"A","field":"x","value":1},
                            {"node":"B","field":"y","value":null}]})");
  EXPECT_EQ(many.id, "");
  EXPECT_EQ(std::get<Set>(many.command->action).values.size(), 2u);

  const Line route = good(R"({"command":"unroute","from":["C","f_changed"],"to":[3,"set_f"]})");
  const auto& change = std::get<ChangeRoute>(route.command->action);
  EXPECT_FALSE(change.add);
  EXPECT_EQ(std::get<uint64_t>(change.to.node), 3u);

  const Line render =
      good(R"({"command":"render","size":[64,48],"samples":4,"channels":["rgba","z"],
                              "file":"x.exr"})");
  const auto& picture = std::get<Render>(render.command->action);
  EXPECT_EQ(*picture.width, 64);
  EXPECT_EQ(*picture.samples, 4);
  EXPECT_EQ(picture.channels.size(), 2u);
  EXPECT_EQ(picture.file, "x.exr");

  const PressKey key =
      std::get<PressKey>(good(R"({"command":"key","key":"F1","pressed":false})").command->action);
  EXPECT_EQ(key.key, "F1");
  EXPECT_EQ(key.pressed, std::optional(false));
  EXPECT_EQ(std::get<PressKey>(good(R"({"command":"key","text":"a b"})").command->action).text,
            "a b");
  EXPECT_EQ(*std::get<Time>(good(R"({"command":"time","skip":0.25})").command->action).skip, .25);
  EXPECT_EQ(std::get<Bind>(good(R"({"command":"bind","viewpoint":2})").command->action).viewpoint,
            "2");
  EXPECT_EQ(std::get<Load>(good(R"({"command":"load","url":"a.wrl"})").command->action).urls.size(),
            1u);
  EXPECT_TRUE(
      std::get<ChangeRoots>(good(R"({"command":"add_root","node":1})").command->action).add);
  good("  {\"command\":\"hello\"}\r");
}

TEST(ControlLine, MessagesSayWhereAndWhat) {
  bad("get Arm rotation", "syntax", "the line is not JSON");
  bad("[1]", "syntax", "a JSON object was expected, not an array of 1");
  bad("", "syntax", "not JSON");
  bad("{}", "command", "the member \"command\" is missing");
  bad(R"({"command":"gte"})", "command", "there is no command \"gte\"; did you mean get?");
  bad(R"({"command":7})", "command", "command: a text was expected, not 7");
  bad(R"({"command":"get","node":"A"})", "command", "get: the member \"field\" is missing");
  bad(R"({"command":"get","node":"A","feild":"x"})", "command", "\"field\" is missing");
  bad(R"({"command":"get","node":"A","field":"x","tiem":1})", "command",
      "get: there is no member \"tiem\"");
  bad(R"({"command":"get","node":-1,"field":"x"})", "command",
      "get: node: the DEF name or the number of a node was expected, not -1");
  bad(R"({"command":"get","node":1.5,"field":"x"})", "command", "not 1.5");
  bad(R"({"command":"set","values":[{"node":"A","field":"x","value":1},{"node":"A"}]})", "command",
      "set: values[1]: the member \"field\" is missing");
  bad(R"({"command":"set","values":[]})", "command", "set: values: an array of objects");
  bad(R"({"command":"render","size":[0,4]})", "command",
      "render: size[0]: a whole number from 1 to 65536 was expected, not 0");
  bad(R"({"command":"render","size":[65536,65536]})", "limit", "pixels=");
  bad(R"({"command":"render","samples":18446744073709551615})", "command", "render: samples");
  bad(R"({"command":"render","samples":1.5})", "command", "render: samples");
  bad(R"({"command":"render","samples":65537})", "command", "render: samples");
  bad(R"({"command":"render","file":"a.png\u0000b"})", "command",
      "render: file: the path of a file");
  bad(R"({"command":"render","file":""})", "command", "render: file: the path of a file");
  bad(R"({"command":"load","url":["a.wrl","b\u0000.wrl"]})", "command", "load: url[1]: the path");
  bad(R"({"command":"create","vrml":"Group\u0000{ }"})", "command",
      "create: vrml: a text without zero bytes");
  bad(R"({"command":"edit","name":"a\u0000b","edits":[{"edit":"rename","node":"A","name":"B"}]})",
      "command", "edit: name: a text without zero bytes");
  bad(R"({"command":"edit","name":"a","edits":[{"edit":"rename","node":"A","name":"B\u0000"}]})",
      "command", "name: a text without zero bytes was expected, not \"B\\u0000\"");
  bad(R"({"command":"key"})", "command", "key");
  bad(R"({"command":"key","key":"a","pressed":1})", "command", "key: pressed");
  bad(R"({"command":"time","skip":-1})", "command", "time: skip: seconds from 0");
  bad(R"({"command":"route","from":["A"],"to":["B","c"]})", "command", "route: from");
  bad(R"({"command":"release","nodes":["A"]})", "command",
      "release: nodes[0]: the number of a node");
  bad(R"({"command":"hello","quiet":1})", "command", "hello: quiet: true or false was expected");
}

// Reads a step with these edits.
edits::Step step(const std::string& edits) {
  const Line line = good(R"({"command":"edit","name":"A step","edits":[)" + edits + "]}");
  return line.command ? std::get<edits::Step>(line.command->action) : edits::Step();
}
void badEdit(const std::string& edits, const std::string& words) {
  bad(R"({"command":"edit","name":"A step","edits":[)" + edits + "]}", "command", words);
}

TEST(ControlLine, StepsAreRead) {
  const edits::Step all = step(R"({"edit":"wrap","node":"A"},
      {"edit":"set","node":{"edit":0},"field":"scale","value":[1,2,3]},
      {"edit":"insert","vrml":"Group {}","parent":{"edit":0},"index":2},
      {"edit":"move","node":7,"at":{"parent":null,"field":null,"index":0},"parent":"B"},
      {"edit":"remove","node":"A","at":{"parent":"B"}},
      {"edit":"unroute","from":[{"edit":2},"a"],"to":["B","b"]})");
  ASSERT_EQ(all.edits.size(), 6u);
  EXPECT_EQ(all.name, "A step");
  EXPECT_EQ(std::get<edits::Wrap>(all.edits[0]).type, "Transform");
  EXPECT_EQ(std::get<edits::Made>(std::get<edits::SetField>(all.edits[1]).node).by, 0u);
  const auto& insert = std::get<edits::Insert>(all.edits[2]);
  EXPECT_EQ(insert.to.field, "children");
  EXPECT_EQ(insert.to.index, std::optional(2u));
  const auto& move = std::get<edits::Move>(all.edits[3]);
  ASSERT_TRUE(move.at);
  EXPECT_FALSE(move.at->parent);
  EXPECT_EQ(move.at->field, "");
  EXPECT_FALSE(move.to.index);
  EXPECT_EQ(std::get<edits::Remove>(all.edits[4]).at->field, "");
  EXPECT_FALSE(std::get<edits::Route>(all.edits[5]).add);
}

TEST(ControlLine, MessagesOfStepsSayWhichEdit) {
  const std::string edit = R"({"edit":"wrap","node":"A"},)";
  bad(R"({"command":"edit","edits":[]})", "command", "\"name\" is missing");
  bad(R"({"command":"edit","name":"","edits":[]})", "command", "name: a name was expected");
  bad(R"({"command":"edit","name":"x","edits":{}})", "command", "edits: an array of objects");
  badEdit("", "edit: edits: an array of objects");
  badEdit("7", "edit: edits[0]: an object was expected, not 7");
  badEdit(R"({"edit":"removed","node":"A"})", "there is no edit \"removed\"; did you mean remove?");
  badEdit(edit + R"({"edit":"set","node":"A","field":"x"})",
          "edit: edits[1]: the member \"value\" is missing");
  badEdit(R"({"edit":"remove","node":"A","index":1})", "there is no member \"index\"");
  badEdit(R"({"edit":"remove","node":"A","at":{"index":1}})", "at: the member \"parent\"");
  badEdit(R"({"edit":"remove","node":"A","at":[]})", "at: an object was expected");
  badEdit(R"({"edit":"insert","vrml":"Group {}","index":-1})", "index: a whole number from 0 to");
  badEdit(R"({"edit":"insert","vrml":"Group {}","index":18446744073709551615})", "index");
  badEdit(R"({"edit":"insert","vrml":"Group {}","index":1.5})", "index");
  badEdit(R"({"edit":"insert","vrml":["Group {}"]})", "vrml: a text was expected");
  badEdit(R"({"edit":"rename","node":[["A"]],"name":"B"})", "node: the DEF name or the number");
  for (const char* const made : {"1", "18446744073709551615", "-1", "\"0\"", "0,\"a\":1"})
    badEdit(edit + R"({"edit":"remove","node":{"edit":)" + made + "}}",
            "edits[1]: node: \"edit\" with the index of an earlier edit");
  badEdit(R"({"edit":"remove","node":"A"},{"edit":"remove","node":{"edit":0}})",
          "an earlier edit that makes a node");
  bad(R"({"command":"save","path":"a\u0000b"})", "command", "save: path: the path of a file");
  bad(R"({"command":"save","overwrite":1})", "command", "save: overwrite: true or false");
  bad(R"({"command":"select","nodes":"A"})", "command", "select: nodes: an array");
  bad(R"({"command":"pick","x":0})", "command", "pick: the member \"y\" is missing");
  bad(R"({"command":"pick","x":0,"y":1.001})", "command", "pick: y: a number from -1 to 1");
  bad(R"({"command":"pick","x":"0","y":0})", "command", "pick: x: a number from -1 to 1");
  bad(R"({"command":"probe","x":0,"y":0,"samples":0})", "command",
      "probe: samples: a whole number");
  bad(R"({"command":"probe","x":0,"y":0,"samples":65537})", "command", "probe: samples");
  bad(R"({"command":"undo","name":"A step"})", "command", "undo: there is no member \"name\"");
  std::string many;
  for (size_t i = 0; i <= limits.edits; ++i) many += R"(,{"edit":"remove","node":"A"})";
  bad(R"({"command":"edit","name":"x","edits":[)" + many.substr(1) + "]}", "limit", "edits=");
}

TEST(ControlLine, ErrorsKeepTheId) {
  const Line line = readLine(R"({"id":"x\"y","command":"nothing"})");
  EXPECT_EQ(line.id, R"("x\"y")");
  EXPECT_EQ(
      errorAnswer(line.id, line.code, "a \xff b"),
      "{\"id\":\"x\\\"y\",\"error\":{\"code\":\"command\",\"message\":\"a \xef\xbf\xbd b\"}}");
  bad(R"({"id":[1],"command":"hello"})", "command", "id: a number or a text");
  bad(R"({"id":")" + std::string(2000, 'x') + R"(","command":"hello"})", "limit", "id:");
}

TEST(ControlLine, HostileLinesAreRefused) {
  bad("{\"command\":\"get\",\"node\":\"\xff\",\"field\":\"x\"}", "syntax", "UTF-8");
  bad(R"({"command":"set","node":"A","field":"x","value":1e400})", "syntax", "1e400");
  bad(R"({"command":"set","node":"A","field":"x","value":NaN})", "syntax", "not JSON");
  bad(R"({"command":"hello","command":"quit"})", "syntax", "the member \"command\" is there twice");
  bad(R"({"a":{"b":1,"b":2}})", "syntax", "\"b\" is there twice");
  bad(R"({"command":"hello"} {"command":"quit"})", "syntax", "not JSON");
  bad(std::string(100'000, '['), "limit", "lineDepth=");
  bad(R"({"command":"set","node":"A","field":"x","value":)" + std::string(100'000, '[') +
          std::string(100'000, ']') + "}",
      "limit", "lineDepth=");
  std::string zeros = R"({"command":"set","node":"A","field":"x","value":[0)";
  for (size_t i = 0; i < limits.lineValues; ++i) zeros += ",0";
  bad(zeros + "]}", "limit", "lineValues=");
  bad(std::string(limits.lineBytes + 1, ' '), "limit", "lineBytes=");
  bad(std::string("{\"command\":\"hello\"\0}", 20), "syntax", "not JSON");
  bad(R"({"command":")" + std::string(1'000'000, 'g') + "\"}", "command", "there is no command");
}

TEST(ControlLine, LimitsAreThoseOfThePage) {
  std::ifstream file("docs/limits.md");
  std::stringstream page;
  page << file.rdbuf();
  const std::pair<const char*, size_t> rows[] = {
      {"lineBytes", limits.lineBytes},
      {"lineDepth", limits.lineDepth},
      {"lineValues", limits.lineValues},
      {"waitingBytes", limits.waitingBytes},
      {"unreadBytes", limits.unreadBytes},
      {"clients", limits.clients},
      {"nodes", limits.nodes},
      {"subscriptions", limits.subscriptions},
      {"edits", limits.edits},
      {"pixels", limits.pixels},
      {"samples", size_t(limits.samples)},
      {"skip", size_t(limits.skip)},
  };
  for (const auto& [name, value] : rows)
    EXPECT_NE(page.str().find(fmt::format("| `{}` | {} | ", name, value)), std::string::npos)
        << "docs/limits.md lacks " << name << " " << value;
  EXPECT_NE(page.str().find(fmt::format("sides up to {} |", limits.side)), std::string::npos);
}

TEST(ControlLine, LimitsAreThoseOfTheCaller) {
  Limits few;
  few.lineValues = 4;
  EXPECT_TRUE(readLine(R"({"command":"hello"})", few).command);
  EXPECT_EQ(readLine(R"({"command":"set","values":[1,2,3]})", few).code, "limit");
  few.lineBytes = 5;
  EXPECT_EQ(readLine(R"({"command":"hello"})", few).code, "limit");
}

} // namespace
