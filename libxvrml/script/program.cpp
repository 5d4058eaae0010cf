#include "script/program.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/data_url.h"
#include "graph/url.h"
#include "parse/source.h"

namespace xvrml {
namespace {

// Returns whether a scheme names a location of files instead of a language.
bool isLocation(std::string_view scheme) {
  constexpr std::string_view places[] = {"",    "file",   "http", "https",
                                         "ftp", "gopher", "urn",  "mailto"};
  return scheme.size() == 1 ||
         std::find(std::begin(places), std::end(places), scheme) != std::end(places);
}

std::string suffixOf(std::string_view path) {
  path = path.substr(0, path.find_first_of("?#"));
  const size_t slash = path.find_last_of("/\\");
  if (slash != path.npos) path.remove_prefix(slash + 1);
  const size_t dot = path.rfind('.');
  std::string suffix(dot == path.npos ? "" : path.substr(dot));
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c + 32);
  return suffix;
}

void append(std::string& reasons, std::string_view reason) {
  if (reasons.size() > 400) return; // a list of URLs can be long
  reasons += reasons.empty() ? "" : "; ";
  reasons += reason;
}

} // namespace

bool ProgramFinder::usable(const XsEngine* engine, const std::string& protocol) {
  if (!engine && (protocol == ".class" || protocol == "java:")) {
    missing_.emplace_back(protocol, "Java Scripts are not supported; they do nothing");
    return false;
  }
  if (!engine) {
    std::string found;
    for (const XsEngine* one : engines_.all())
      found += (found.empty() ? "" : ", ") + std::string(one->name);
    missing_.emplace_back(
        protocol, fmt::format("no script engine for '{}' is installed (looked in: {}; found: {}); "
                              "Scripts of this protocol do nothing",
                              protocol, engines_.searched(), found.empty() ? "none" : found));
    return false;
  }
  if ((engine->flags & XS_NEEDS_TRUST) && !trusted_) {
    missing_.emplace_back(
        protocol,
        fmt::format("'{}' is run by engine {}, whose programs can do whatever the user can: only "
                    "in worlds that are trusted (vv --trust); Scripts of this protocol do nothing",
                    protocol, engine->name));
    return false;
  }
  return true;
}

bool ProgramFinder::inlineProgram(const std::string& url, size_t colon, ScriptProgram& program) {
  program.engine = engines_.byScheme(program.scheme);
  if (!usable(program.engine, program.scheme + ":")) return false;
  program.text = url.substr(colon + 1);
  return true;
}

bool ProgramFinder::fileProgram(const std::string& url, const std::string& base,
                                const LoadOptions& options, ScriptProgram& program) {
  const ResolvedUrl resolved = resolveUrl(url, base, options);
  const std::string suffix = suffixOf(url);
  program.engine = suffix.empty() ? nullptr : engines_.bySuffix(suffix);
  if (!program.engine && suffix.empty()) {
    append(reasons_, fmt::format("'{}' is not a known kind of program", url.substr(0, 100)));
    return false;
  }
  if (!usable(program.engine, suffix)) return false;
  if (!resolved.error.empty()) {
    append(reasons_, resolved.error);
    return false;
  }
  try {
    program.text = Source::open(resolved.path, options.limits, nullptr).text();
  } catch (const LoadError& error) {
    append(reasons_, error.diagnostic.text());
    return false;
  }
  if (program.text.size() > options.limits.stringBytes) {
    append(reasons_, fmt::format("'{}' is longer than limit stringBytes={}", resolved.path,
                                 options.limits.stringBytes));
    return false;
  }
  program.start = {std::make_shared<const std::string>(resolved.path), 1, 0};
  return true;
}

bool ProgramFinder::dataProgram(std::string_view url, const LoadOptions& options,
                                ScriptProgram& program) {
  DataUrl data;
  std::string why;
  if (!decodeDataUrl(url, options.limits.stringBytes, data, why)) {
    append(reasons_, why);
    return false;
  }
  program.engine = data.type.empty() ? nullptr : engines_.byMimeType(data.type);
  if (!usable(program.engine, "data:" + data.type.substr(0, 100))) return false;
  program.text = std::move(data.bytes);
  return true;
}

void ProgramFinder::reportMissing(const ScriptNode& script) {
  for (const auto& [protocol, message] : missing_)
    if (reported_.insert(protocol).second) diagnostics_.warn(script.source, "Script: " + message);
  if (!reasons_.empty()) diagnostics_.warn(script.source, "Script does nothing: " + reasons_);
}

ScriptProgram ProgramFinder::find(const ScriptNode& script, const LoadOptions& options,
                                  size_t first) {
  ScriptProgram program = peek(script, options, first);
  reportRefusals();
  if (!program.engine) reportMissing(script);
  return program;
}

ScriptProgram ProgramFinder::peek(const ScriptNode& script, const LoadOptions& options,
                                  size_t first) {
  missing_.clear();
  reasons_.clear();
  const FieldInfo* field = script.type().find("url");
  const auto urls = std::get<MFString>(script.get(*field));
  const std::string base = script.source.file ? *script.source.file : "";
  ScriptProgram program;
  for (size_t i = first; i < urls.size(); ++i) {
    program = {};
    const std::string& url = urls[i];
    const size_t start = std::min(url.find_first_not_of(" \t\r\n"), url.size());
    const std::string_view trimmed = std::string_view(url).substr(start);
    std::string scheme = urlScheme(trimmed);
    if (scheme == "data") {
      if (!dataProgram(trimmed, options, program)) continue;
      program.start = {script.source.file,
                       i < script.urlLines.size() ? script.urlLines[i] : script.source.line, 0};
    } else if (isLocation(scheme)) {
      if (!fileProgram(url, base, options, program)) continue;
    } else {
      program.scheme = std::move(scheme);
      const uint32_t line = i < script.urlLines.size() ? script.urlLines[i] : script.source.line;
      program.start = {script.source.file,
                       line + uint32_t(std::count(url.begin(), url.begin() + long(start), '\n')),
                       0};
      if (!inlineProgram(url, start + program.scheme.size(), program)) continue;
    }
    program.url = i;
    return program;
  }
  return {};
}

void ProgramFinder::reportRefusals() {
  for (const std::string& refusal : engines_.takeRefusals()) diagnostics_.warn({}, refusal);
}

} // namespace xvrml
