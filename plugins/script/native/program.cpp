// program.cpp: Implements program.h. The grammar is that of docs/scripts.md, "Native functions":
//
//   program  = library [ "#" call { (newline | ";") call } ]
//   call     = [ when ":" ] [ "if" | "unless" | [type] name "=" ]
//              function [ "(" [ argument { "," argument } ] ")" ]
//   argument = number | [type] [ "&" ] name [ ".data" | ".count" | "[" number "]" ]
#include "program.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

#include <xvrml/xscript_types.h>

#include "slots.h"

namespace native {
namespace {

constexpr size_t maxCalls = 1000, maxArguments = 100;
constexpr uint32_t maxRoom = 1 << 24;

struct Word {
  const char* name;
  Number number;
};
constexpr Word words[] = {
    {"float", Number::f32},    {"double", Number::f64},  {"int", Number::i32},
    {"unsigned", Number::u32}, {"long", Number::i64},    {"short", Number::i16},
    {"char", Number::i8},      {"bool", Number::u8},     {"size_t", Number::u64},
    {"int8_t", Number::i8},    {"uint8_t", Number::u8},  {"int16_t", Number::i16},
    {"uint16_t", Number::u16}, {"int32_t", Number::i32}, {"uint32_t", Number::u32},
    {"int64_t", Number::i64},  {"uint64_t", Number::u64}};
static_assert(sizeof(long) == 8 && sizeof(size_t) == 8);

bool isScalar(XsType type) {
  return type == XS_SFBOOL || type == XS_SFFLOAT || type == XS_SFINT32 || type == XS_SFTIME ||
         type == XS_SFDOUBLE;
}
// Returns the name of the event that a field receives; "" if it receives none.
std::string eventName(const XsField& field) {
  if (field.access == XS_EVENT_IN) return field.name;
  return field.access == XS_EXPOSED_FIELD ? std::string("set_") + field.name : std::string();
}
bool isLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Reader {
 public:
  Reader(std::string_view text, uint32_t line, const XsScriptInfo& info)
      : text_(text), line_(line), info_(info) {}

  Call call() {
    Call call;
    call.line = line_;
    std::string word = name("the name of a function");
    if (take(':')) {
      when(call, word);
      word = name("the name of a function");
    }
    if ((word == "if" || word == "unless") && more()) {
      call.sends = word == "if" ? Call::Sends::ifTrue : Call::Sends::ifFalse;
      word = name("the name of a function");
    } else if (more() && text_[at_] != '(') { // [type] target =
      const Number number = typeNamed(word);
      if (number != Number::none) word = name("the name of an eventOut");
      if (!take('=')) fail("'=' or '(' was expected behind '" + word + "'");
      call.result = true;
      call.target = fieldNamed(word, number);
      call.target.write = true;
      checkResult(call.target);
      word = name("the name of a function");
    }
    call.function = word;
    if (take('(')) {
      if (!take(')')) {
        do call.arguments.push_back(argument());
        while (take(',') && call.arguments.size() < maxArguments);
        if (!take(')')) fail("',' or ')' was expected");
      }
    } else {
      deriveArguments(call);
    }
    if (more()) fail("unexpected '" + std::string(text_.substr(at_, 20)) + "'");
    return call;
  }

  // Derives arguments that are not written from the declarations.
  void deriveArguments(Call& call) const {
    const bool quiet = call.when == Call::When::initialize || call.when == Call::When::shutdown;
    std::vector<Argument> outs;
    for (uint32_t i = 0; i < info_.fieldCount; ++i) {
      Argument argument;
      argument.field = i;
      const XsAccess access = info_.fields[i].access;
      const bool event =
          call.when == Call::When::events || (call.when == Call::When::event && call.event == i);
      if (access == XS_FIELD || access == XS_EXPOSED_FIELD || (access == XS_EVENT_IN && event))
        call.arguments.push_back(argument);
      argument.write = true;
      if (access == XS_EVENT_OUT && !quiet) outs.push_back(argument);
    }
    if (call.when == Call::When::poll) {
      if (call.sends == Call::Sends::always && !call.result) call.sends = Call::Sends::ifTrue;
    } else if (outs.size() == 1 && isScalar(info_.fields[outs[0].field].type) &&
               call.sends == Call::Sends::always && !call.result) {
      call.result = true;
      call.target = outs[0];
    }
    if (!call.result) call.arguments.insert(call.arguments.end(), outs.begin(), outs.end());
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw ProgramError(line_, what); }
  bool more() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size();
  }
  bool take(char c) {
    if (!more() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string name(const char* what) {
    if (!more() || !isLetter(text_[at_])) fail(std::string(what) + " was expected");
    const size_t from = at_;
    while (at_ < text_.size() && isLetter(text_[at_])) ++at_;
    return std::string(text_.substr(from, at_ - from));
  }
  static Number typeNamed(const std::string& word) {
    for (const Word& known : words)
      if (word == known.name) return known.number;
    return Number::none;
  }

  void when(Call& call, const std::string& word) const {
    constexpr std::pair<const char*, Call::When> fixed[] = {{"initialize", Call::When::initialize},
                                                            {"poll", Call::When::poll},
                                                            {"shutdown", Call::When::shutdown}};
    for (uint32_t i = 0; i < info_.fieldCount; ++i)
      if (word == eventName(info_.fields[i])) {
        call.when = Call::When::event;
        call.event = i;
        return;
      }
    for (const auto& [known, time] : fixed)
      if (word == known) {
        call.when = time;
        return;
      }
    fail("'" + word + ":' is neither an eventIn of the Script nor initialize, poll or shutdown");
  }

  Argument fieldNamed(const std::string& word, Number number) const {
    Argument argument;
    argument.number = number;
    for (uint32_t i = 0; i < info_.fieldCount; ++i)
      if (word == info_.fields[i].name) {
        argument.field = i;
        argument.write = info_.fields[i].access == XS_EVENT_OUT;
        if (number != Number::none && !isScalar(info_.fields[i].type))
          fail("'" + word +
               "': only SFBool, SFDouble, SFFloat, SFInt32 and SFTime can have another type in C");
        return argument;
      }
    if (word == "host" || word == "self" || word == "time") {
      argument.kind = word == "host"   ? Argument::Kind::host
                      : word == "self" ? Argument::Kind::self
                                       : Argument::Kind::time;
      return argument;
    }
    fail("'" + word + "' is not a field or event of the Script");
  }

  void checkResult(const Argument& target) const {
    const XsField* field =
        target.kind == Argument::Kind::field ? &info_.fields[target.field] : nullptr;
    if (!field || field->access == XS_EVENT_IN) fail("a result goes to an eventOut or a field");
    if (!isScalar(field->type) && field->type != XS_SFSTRING && field->type != XS_SFNODE)
      fail(std::string("'") + field->name +
           "': a function returns SFBool, SFDouble, SFFloat, SFInt32, SFTime, SFString or SFNode; "
           "other "
           "types are arguments that it writes to");
  }

  double number() {
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc() || end == text_.data() + at_) fail("a number was expected");
    at_ = size_t(end - text_.data());
    return value;
  }

  Argument literal(Number type) {
    const size_t from = at_;
    Argument argument;
    argument.value = number();
    const std::string_view written = text_.substr(from, at_ - from);
    const bool real = written.find_first_of(".eE") != written.npos;
    argument.kind = real ? Argument::Kind::real : Argument::Kind::integer;
    argument.number = type != Number::none ? type : real ? Number::f64 : Number::i32;
    // whole numbers that a double represents exactly
    const double most = argument.number == Number::i32 ? 2147483647.0 : 9.0e15;
    if (!real && !(argument.value >= -most - 1 && argument.value <= most))
      fail("a number that is too large");
    return argument;
  }

  Argument argument() {
    if (!more()) fail("an argument was expected");
    Number type = Number::none;
    if (std::isalpha(static_cast<unsigned char>(text_[at_]))) {
      const size_t from = at_;
      type = typeNamed(name("an argument"));
      if (type == Number::none || !more() || text_[at_] == ',' || text_[at_] == ')') {
        at_ = from;
        type = Number::none;
      }
      more();
    }
    const char c = at_ < text_.size() ? text_[at_] : ' ';
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '.') return literal(type);
    const bool address = take('&');
    Argument argument = fieldNamed(name("an argument"), type);
    if (argument.kind != Argument::Kind::field) return argument;
    const XsField& field = info_.fields[argument.field];
    if (address) {
      if (field.access == XS_EVENT_IN)
        fail(std::string("'&") + field.name + "': an eventIn cannot be written");
      argument.write = true;
    }
    if (take('.')) {
      const std::string part = name("data or count");
      if (part != "data" && part != "count") fail("'." + part + "': data or count was expected");
      argument.part = part == "data" ? Argument::Part::data : Argument::Part::count;
    } else if (take('[')) {
      if (!more()) fail("a number was expected");
      const double room = number();
      if (!argument.write || (!xsIsMany(field.type) && field.type != XS_SFSTRING) ||
          !(room >= 1 && room <= maxRoom) || room != double(uint32_t(room)))
        fail(std::string("'") + field.name +
             "[...]': a number of elements that the function writes to an MF type or an SFString");
      argument.room = uint32_t(room);
      if (!take(']')) fail("']' was expected");
    }
    if (argument.write && (elementType(field.type) == XS_SFIMAGE || field.type == XS_MFSTRING))
      fail(std::string("'") + field.name +
           "': a function cannot write an SFImage, MFImage or MFString; give it host and self");
    return argument;
  }

  std::string_view text_;
  uint32_t line_;
  const XsScriptInfo& info_;
  size_t at_ = 0;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return text;
}

// Creates the calls for a program that names only a library: functions with the names of the
// eventIns, and initialize, poll, shutdown.
void callsByName(Program& program, const XsScriptInfo& info, const Lookup& own) {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < info.fieldCount; ++i)
    if (const std::string event = eventName(info.fields[i]); !event.empty()) names.push_back(event);
  for (const char* fixed : {"initialize", "poll", "shutdown"})
    if (std::find(names.begin(), names.end(), fixed) == names.end()) names.emplace_back(fixed);
  std::string looked;
  for (const std::string& name : names) {
    looked += (looked.empty() ? "" : ", ") + name;
    if (own(name)) program.calls.push_back(Reader(name + ":" + name, 1, info).call());
  }
  if (program.calls.empty())
    throw ProgramError(1, program.library + " has none of the functions " + looked);
}

} // namespace

std::string libraryName(std::string_view text) {
  return std::string(trimmed(text.substr(0, text.find('#'))));
}

Program readProgram(std::string_view text, const XsScriptInfo& info, const Lookup& exports,
                    const Lookup& own) {
  Program program;
  program.library = libraryName(text);
  const size_t hash = text.find('#');
  uint32_t line = 1 + uint32_t(std::count(text.begin(),
                                          text.begin() + long(std::min(hash, text.size())), '\n'));
  for (size_t at = hash == text.npos ? text.size() : hash + 1; at < text.size();) {
    const size_t end = std::min(text.find_first_of("\n;", at), text.size());
    const std::string_view one = trimmed(text.substr(at, end - at));
    if (!one.empty() && !one.starts_with("//")) {
      if (program.calls.size() >= maxCalls) throw ProgramError(line, "too many calls");
      program.calls.push_back(Reader(one, line, info).call());
      const std::string& function = program.calls.back().function;
      if (!exports(function))
        throw ProgramError(line, program.library + " has no function '" + function + "'");
    }
    if (end < text.size() && text[end] == '\n') ++line;
    at = end + 1;
  }
  if (program.calls.empty()) callsByName(program, info, own);
  return program;
}

} // namespace native
