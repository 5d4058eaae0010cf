// step.cpp: reads STEP models (ISO 10303-21). The program xvrml-step-reader turns them into glTF in
// a process that can only compute (docs/decisions/0114); the reader of glTF checks that as it does
// any file of strangers.
#include <stdexcept>

#include <fmt/format.h>

#include "decode/decoder.h"
#include "parse/encodings.h"

namespace xvrml {
namespace {

// Returns the model as a binary glTF file, and sets what the reader says about it. The memory is
// taken from scratch.
std::string glbOf(const MeshFile& file, Scratch& scratch, decoding::Contents& about) {
  const auto* const bytes = reinterpret_cast<const uint8_t*>(file.bytes.data());
  std::string glb;
  stepReaderOf(file.budget.get())
      ->decode(
          {decoding::Format::step,
           {bytes, file.bytes.size()},
           file.budget->left(),
           file.options.stepError},
          [&](const decoding::Contents& contents) {
            if (contents.rows != 1 || contents.components != 1 || contents.componentBytes != 1)
              throw std::runtime_error("the process that reads it broke the protocol");
            scratch.take(contents.columns);
            glb.reserve(contents.columns);
            about = contents;
            return true;
          },
          [&](std::span<const char> part) { glb.append(part.data(), part.size()); });
  return glb;
}

} // namespace

bool isStep(std::string_view bytes, std::string_view) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != bytes.npos && bytes.substr(first).starts_with("ISO-10303-21");
}

void readStep(const MeshFile& file) {
  Scratch scratch(file.budget);
  std::string glb;
  decoding::Contents about{};
  try {
    glb = glbOf(file, scratch, about);
  } catch (const std::runtime_error& error) {
    throw LoadError{{Severity::error,
                     file.path,
                     0,
                     0,
                     fmt::format("this STEP model cannot be read: {}", error.what()),
                     {},
                     0}};
  }
  if (about.leftOut > 0)
    file.locator.warn(nullptr, fmt::format("{} faces of the STEP model are left out: no triangles "
                                           "could be made of them",
                                           about.leftOut));
  if (about.away > 0) warnIfFar(file.locator, about.away, about.size, "metres");
  readGltf({glb, file.path, file.locator, file.sink, file.options, file.budget, file.names});
}

} // namespace xvrml
