// encodings.cpp: names, kinds and readers of encodings, from their table. Names are not inline, so
// that programs built before an encoding was added know it as soon as the library does.
#include "parse/encodings.h"

#include <algorithm>
#include <deque>
#include <iterator>
#include <optional>

#include "decode/decoder.h"
#include "lower_case.h"
#include "parse/builder.h"
#include "parse/classic_recorder.h"
#include "parse/parser.h"
#include "parse/source.h"
#include "parse/vrml1/vrml1.h"

namespace xvrml {

const EncodingInfo* encodingInfo(Encoding encoding) {
  const auto* found =
      std::find_if(std::begin(encodingTable), std::end(encodingTable),
                   [&](const EncodingInfo& info) { return info.encoding == encoding; });
  return found == std::end(encodingTable) ? nullptr : found;
}

int encodingCount() {
  int count = 0;
  while (encodingInfo(static_cast<Encoding>(count))) ++count;
  return count;
}

std::string_view encodingName(Encoding encoding) {
  const EncodingInfo* info = encodingInfo(encoding);
  return info ? info->name : "unknown";
}

bool isMesh(Encoding encoding) {
  const EncodingInfo* info = encodingInfo(encoding);
  return info && info->readMesh;
}

std::string_view meshSuffixes(Encoding encoding) {
  const EncodingInfo* info = encodingInfo(encoding);
  return info ? info->meshSuffixes : std::string_view();
}

std::string whyNotReadable(Encoding encoding) {
  std::string why;
  if (encoding == Encoding::step) findHelper(stepReader.program, why);
  return why;
}

const EncodingInfo* recogniseEncoding(std::string_view text, std::string_view path) {
  for (const EncodingInfo& info : encodingTable)
    if (info.recognises && info.recognises(text, path)) return &info;
  return nullptr;
}

const EncodingInfo* meshNamedBy(std::string_view path) {
  std::string name = lowerCase(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  const size_t dot = name.rfind('.');
  if (dot == name.npos) return nullptr;
  const std::string suffix = name.substr(dot) + " ";
  for (const EncodingInfo& info : encodingTable)
    if ((std::string(info.meshSuffixes) + " ").find(suffix) != std::string::npos) return &info;
  return nullptr;
}

void readVrml(const WorldFile& file) {
  Locator locator(file.bytes, file.name, file.state.diagnostics);
  Builder builder(locator, file.state, file.content);
  Lexer lexer(locator);
  std::optional<ClassicRecorder> recorder;
  if (file.state.layout) recorder.emplace(builder, locator, *file.state.layout);
  ParseSink& sink = recorder ? static_cast<ParseSink&>(*recorder) : builder;
  Parser(lexer, file.state.options.limits, sink, file.budget.get(),
         file.content.head.version.isX3d())
      .vrmlScene();
  builder.finish();
}

void readVrml1(const WorldFile& file) {
  Locator locator(file.bytes, file.name, file.state.diagnostics);
  readVrml1(locator, file.state, file.content, Parser::maximumNesting);
}

namespace {

void readMeshFile(const EncodingInfo& info, const WorldFile& file) {
  Locator locator(file.bytes, file.name, file.state.diagnostics);
  std::deque<std::string> names; // DEF names that a reader makes; they outlive the builder
  Builder builder(locator, file.state, file.content);
  try {
    info.readMesh(
        {file.bytes, *file.name, locator, builder, file.state.options, file.budget, names});
  } catch (const MeshFault& fault) { locator.error(fault.at, fault.message); }
  builder.finish();
}

} // namespace

void readWorldFile(const WorldFile& file) {
  const EncodingInfo& info = *encodingInfo(file.content.head.version.encoding);
  WorldFile text = file;
  if (!info.mayBeBinary) text.bytes = withoutDosEnd(file.bytes);
  info.readMesh ? readMeshFile(info, text) : info.read(text);
}

} // namespace xvrml
