// config.cpp: parses the options of a context. Grammar:
//   options ::= { blank } [ key "=" value { blank } ... ]
//   value   ::= '"' { any but '"' } '"'  |  { any but blank }
#include "api/config.h"

#include <algorithm>
#include <iterator>

#include "api/errors.h"
#include "number_text.h"

namespace openrt {
namespace {
constexpr std::string_view blanks = " \t\r\n";
constexpr uint32_t maxThreads = 1024, maxWorkers = 65536;

uint32_t parseNumber(std::string_view key, std::string_view text, uint32_t most) {
  uint32_t value = 0;
  if (!isNumber(text, value) || value > most)
    fail(RT_INVALID_VALUE, std::string(key) + "=" + std::string(text) +
                               ": expected a number from 0 to " + std::to_string(most));
  return value;
}

BackendKind parseBackend(std::string_view text) {
  if (text == "local") return BackendKind::Local;
  if (text == "null") return BackendKind::Null;
  if (text == "record") return BackendKind::Record;
  if (text == "cluster") return BackendKind::Cluster;
  fail(RT_INVALID_VALUE,
       "backend=" + std::string(text) +
           ": expected local, null, record or cluster, or debug: and one of these");
}

// Removes one value from the front of the text and returns it.
std::string_view takeValue(std::string_view& text, std::string_view key) {
  if (text.starts_with('"')) {
    const size_t end = text.find('"', 1);
    if (end == text.npos)
      fail(RT_INVALID_VALUE, std::string(key) + ": the closing quote is missing");
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
  if (value.find('\0') != value.npos)
    fail(RT_INVALID_VALUE, std::string(key) + ": the value contains a null character");
  constexpr std::string_view debugging = "debug:";
  if (key == "backend") {
    const bool wrapped = value.starts_with(debugging);
    backend = parseBackend(wrapped ? value.substr(debugging.size()) : value);
    debug = wrapped;
  } else if (key == "threads")
    threads = parseNumber(key, value, maxThreads);
  else if (key == "isa")
    isa = value;
  else if (key == "file")
    file = value;
  else if (key == "record")
    record = value;
  else if (key == "shaderpath")
    shaderPath = value;
  else if (key == "lightsamples") {
    if (value != "on" && value != "off")
      fail(RT_INVALID_VALUE, "lightsamples=" + std::string(value) + ": expected on or off");
    lightSamples = value == "on";
  } else if (setCluster(key, value))
    clusterKey_ = key;
  else
    fail(RT_INVALID_VALUE,
         "unknown option \"" + std::string(key) +
             "\"; the options are backend, threads, isa, file, record, shaderpath, "
             "lightsamples, and for backend=cluster workers, listen, key, allow, local, split, "
             "require, tolerant");
}

bool ContextConfig::setCluster(std::string_view key, std::string_view value) {
  if (key == "workers") {
    for (size_t begin = 0; begin <= value.size();) {
      const size_t end = std::min(value.find(',', begin), value.size());
      if (end == begin)
        fail(RT_INVALID_VALUE,
             "workers=" + std::string(value) + ": expected HOST[:PORT],... or @FILE");
      cluster.workers.emplace_back(value.substr(begin, end - begin));
      begin = end + 1;
    }
  } else if (key == "listen")
    cluster.listen = value;
  else if (key == "key")
    cluster.keyFile = value;
  else if (key == "allow")
    cluster.allowFile = value;
  else if (key == "local")
    cluster.local = parseNumber(key, value, maxThreads);
  else if (key == "split") {
    constexpr std::string_view known[] = {"auto", "tiles", "samples", "frames"};
    if (std::find(std::begin(known), std::end(known), value) == std::end(known))
      fail(RT_INVALID_VALUE,
           "split=" + std::string(value) + ": expected auto, tiles, samples or frames");
    cluster.split = value;
  } else if (key == "require")
    cluster.require = parseNumber(key, value, maxWorkers);
  else if (key == "tolerant")
    cluster.tolerant = parseNumber(key, value, 1) == 1;
  else
    return false;
  return true;
}

void ContextConfig::check() const {
  if (backend == BackendKind::Record && file.empty())
    fail(RT_INVALID_VALUE, "backend=record needs file=PATH");
  if (backend == BackendKind::Record && !record.empty())
    fail(RT_INVALID_VALUE, "record=PATH needs a backend that renders");
  if (backend != BackendKind::Record && !file.empty())
    fail(RT_INVALID_VALUE, "file=PATH needs backend=record");
  if ((backend == BackendKind::Record || backend == BackendKind::Null) && isa != automaticIsa)
    fail(RT_INVALID_VALUE, "isa=NAME needs a backend that renders");
  if (backend != BackendKind::Local && !lightSamples)
    fail(RT_INVALID_VALUE, "lightsamples=off needs backend=local");
  if (backend != BackendKind::Cluster && !clusterKey_.empty())
    fail(RT_INVALID_VALUE, clusterKey_ + "= needs backend=cluster");
  if (backend == BackendKind::Cluster && cluster.workers.empty() && cluster.listen.empty())
    fail(RT_INVALID_VALUE,
         "backend=cluster needs workers=HOST[:PORT],... or listen=ADDRESS[:PORT], or both");
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
