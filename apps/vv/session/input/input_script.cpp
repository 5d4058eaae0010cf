#include "session/input/input_script.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "file_contents.h"
#include "options/values.h"

namespace vv {

namespace {

using Kind = InputEvent::Kind;

constexpr const char* buttons[] = {"left", "middle", "right"};

struct Word {
  const char* name;
  Kind kind;
};
constexpr Word words[] = {
    {"move", Kind::move},   {"press", Kind::press}, {"release", Kind::release},
    {"leave", Kind::leave}, {"wheel", Kind::wheel}, {"down", Kind::down},
    {"up", Kind::up},       {"key", Kind::down},    {"type", Kind::type},
    {"save", Kind::save},   {"quit", Kind::quit},   {"viewpoint", Kind::viewpoint}};

const char* wordOf(Kind kind) {
  for (const Word& word : words)
    if (word.kind == kind) return word.name;
  return "";
}

struct Line {
  std::istringstream rest;
  std::string next(const char* what) {
    std::string word;
    if (!(rest >> word)) throw UsageError(fmt::format("{} was expected", what));
    return word;
  }
  // Reads a name, in quotation marks if it has several words.
  std::string nextName(const char* what) {
    std::string name;
    if (!(rest >> std::quoted(name)) || name.empty())
      throw UsageError(fmt::format("{} was expected", what));
    return name;
  }
  std::string all(const char* what) {
    std::string text;
    std::getline(rest >> std::ws, text);
    if (text.empty()) throw UsageError(fmt::format("{} was expected", what));
    return text;
  }
};

double readPlace(const std::string& text) { return text == "0" ? 0 : readNumber(text, -100, 100); }

void readModifiers(Line& line, InputEvent& event) {
  for (std::string word; line.rest >> word;) {
    if (word == "shift")
      event.shift = true;
    else if (word == "ctrl")
      event.control = true;
    else if (word == "alt")
      event.alt = true;
    else
      throw UsageError(fmt::format("shift, ctrl or alt was expected, not \"{}\"", word));
  }
}

InputEvent readEvent(const std::string& name, Line& line, double& x, double& y) {
  InputEvent event;
  const Word* found = nullptr;
  for (const Word& word : words)
    if (name == word.name) found = &word;
  if (!found) throw UsageError(fmt::format("there is no event \"{}\"", name));
  event.kind = found->kind;
  switch (event.kind) {
  case Kind::move:
    x = readPlace(line.next("a place"));
    y = readPlace(line.next("a place"));
    break;
  case Kind::press:
  case Kind::release: {
    const std::string button = line.next("a button");
    if (button != "left" && button != "middle" && button != "right")
      throw UsageError(fmt::format("left, middle or right was expected, not \"{}\"", button));
    event.button = button == "left"     ? Button::left
                   : button == "middle" ? Button::middle
                                        : Button::right;
    const auto at = line.rest.tellg();
    std::string word;
    if (line.rest >> word && word != "shift" && word != "ctrl" && word != "alt") {
      x = readPlace(word);
      y = readPlace(line.next("a place"));
    } else {
      line.rest.clear();
      line.rest.seekg(at);
    }
    readModifiers(line, event);
    break;
  }
  case Kind::wheel: event.amount = readPlace(line.next("a number of notches")); break;
  case Kind::down:
  case Kind::up:
    event.text = line.nextName("a key");
    readModifiers(line, event);
    break;
  case Kind::type: event.text = line.nextName("a text"); break;
  case Kind::viewpoint: event.text = line.all("a name"); break;
  case Kind::save:
  case Kind::open: event.text = line.all("a file name"); break;
  case Kind::leave:
  case Kind::quit: break;
  }
  event.x = x;
  event.y = y;
  std::string more;
  if (line.rest >> more) throw UsageError(fmt::format("\"{}\" was not expected", more));
  return event;
}

// Returns a name as nextName() reads it.
std::string nameInLine(const std::string& name) {
  if (name.find_first_of(" \t\"\\") == name.npos) return name;
  std::ostringstream text;
  text << std::quoted(name);
  return text.str();
}

} // namespace

InputScript parseInputScript(std::string_view text, const std::string& name) {
  InputScript script;
  double x = 0, y = 0;
  int number = 0;
  for (std::string_view row : split(text, '\n')) {
    ++number;
    if (row.ends_with('\r')) row.remove_suffix(1);
    Line line{std::istringstream(std::string(row))};
    std::string time;
    if (!(line.rest >> time) || time[0] == '#') continue;
    try {
      const double seconds = time == "0" ? 0 : readNumber(time, -1e-9, 1e6);
      if (seconds < script.end) throw UsageError("it is earlier than the line before");
      script.end = seconds;
      const std::string event = line.next("an event");
      if (event == "end") continue;
      script.events.push_back({seconds, readEvent(event, line, x, y)});
      if (event != "key") continue;
      script.events.push_back(script.events.back());
      script.events.back().event.kind = Kind::up;
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}:{}: {}", name, number, error.what()));
    }
  }
  return script;
}

InputScript readInputScript(const std::string& path) {
  constexpr size_t most = 256 << 20; // hours of moves
  try {
    return parseInputScript(fileContents(path, most), path);
  } catch (const UsageError& error) {
    throw Failure{exitInput, error.what()};
  } catch (const std::runtime_error& why) {
    throw Failure{exitInput, fmt::format("--input: cannot read {}: {}", path, why.what())};
  }
}

std::string inputLine(double time, const InputEvent& event) {
  std::string line = fmt::format("{} {}", time, wordOf(event.kind));
  switch (event.kind) {
  case Kind::move: line += fmt::format(" {} {}", event.x, event.y); break;
  case Kind::press:
  case Kind::release:
    line += fmt::format(" {} {} {}", buttons[int(event.button)], event.x, event.y);
    break;
  case Kind::wheel: line += fmt::format(" {}", event.amount); break;
  case Kind::down:
  case Kind::up:
  case Kind::type: line += " " + nameInLine(event.text); break;
  case Kind::viewpoint:
  case Kind::save:
  case Kind::open: line += " " + event.text; break;
  case Kind::leave:
  case Kind::quit: break;
  }
  const bool modified = event.kind == Kind::press || event.kind == Kind::release ||
                        event.kind == Kind::down || event.kind == Kind::up;
  if (modified)
    line += fmt::format("{}{}{}", event.shift ? " shift" : "", event.control ? " ctrl" : "",
                        event.alt ? " alt" : "");
  return line + "\n";
}

} // namespace vv
