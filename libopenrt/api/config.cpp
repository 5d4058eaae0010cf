// config.cpp: grammar  options ::= { blank } [ key "=" ( '"' { any but '"' } '"' | { any but blank } ) { blank } ... ]
#include "api/config.h"

#include <charconv>

#include "api/errors.h"

namespace openrt {
namespace {
constexpr std::string_view blanks = " \t\r\n";
constexpr uint32_t maxThreads = 1024;

uint32_t parseThreads(std::string_view text) {
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value > maxThreads)
    fail(RT_INVALID_VALUE, "threads=" + std::string(text) + ": expected a number from 0 to " + std::to_string(maxThreads));
  return value;
}

BackendKind parseBackend(std::string_view text) {
  if (text == "local") return BackendKind::Local;
  if (text == "null") return BackendKind::Null;
  if (text == "record") return BackendKind::Record;
  fail(RT_INVALID_VALUE, "backend=" + std::string(text) + ": expected local, null or record, or debug: and one of these");
}

// Takes one value off the front of the text.
std::string_view takeValue(std::string_view& text, std::string_view key) {
  if (text.starts_with('"')) {
    const size_t end = text.find('"', 1);
    if (end == text.npos) fail(RT_INVALID_VALUE, std::string(key) + ": the closing quote is missing");
    const std::string_view value = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    if (!text.empty() && blanks.find(text.front()) == blanks.npos)
      fail(RT_INVALID_VALUE, std::string(key) + ": expected a blank after the closing quote");
    return value;
  }
  const std::string_view value = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(value.size());
  return value;
}

} // namespace

void ContextConfig::set(std::string_view key, std::string_view value) {
  if (value.find('\0') != value.npos) fail(RT_INVALID_VALUE, std::string(key) + ": a null character in its value");
  constexpr std::string_view debugging = "debug:";
  if (key == "backend") {
    const bool wrapped = value.starts_with(debugging);
    backend = parseBackend(wrapped ? value.substr(debugging.size()) : value);
    debug = wrapped;
  } else if (key == "threads")
    threads = parseThreads(value);
  else if (key == "file")
    file = value;
  else if (key == "record")
    record = value;
  else if (key == "shaderpath")
    shaderPath = value;
  else
    fail(RT_INVALID_VALUE, "unknown option \"" + std::string(key) + "\"; known are backend, threads, file, record, shaderpath");
}

void ContextConfig::check() const {
  if (backend == BackendKind::Record && file.empty()) fail(RT_INVALID_VALUE, "backend=record needs file=PATH");
  if (backend == BackendKind::Record && !record.empty()) fail(RT_INVALID_VALUE, "record=PATH is for backends that render");
  if (backend != BackendKind::Record && !file.empty()) fail(RT_INVALID_VALUE, "file=PATH is for backend=record");
}

ContextConfig parseConfig(std::string_view text) {
  ContextConfig config;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.empty()) break;
    const size_t equals = text.find_first_of("= \t\r\n");
    if (equals == text.npos || text[equals] != '=' || equals == 0)
      fail(RT_INVALID_VALUE, "expected key=value at \"" + std::string(text.substr(0, 40)) + "\"");
    const std::string_view key = text.substr(0, equals);
    text.remove_prefix(equals + 1);
    config.set(key, takeValue(text, key));
  }
  config.check();
  return config;
}

} // namespace openrt
