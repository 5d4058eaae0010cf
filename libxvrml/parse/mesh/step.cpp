// step.cpp: reads STEP models (ISO 10303-21). The program xvrml-step-reader turns them into glTF in
// a process that can only compute (docs/decisions/0114); the reader of glTF checks that as it does
// any file of strangers.
#include <stdexcept>

#include <fmt/format.h>

#include "decode/decoder.h"
#include "parse/encodings.h"
#include "xvrml/step_error.h"

namespace xvrml {
namespace {

// Returns the model as a binary glTF file, and sets the number of faces that are left out. The
// memory is taken from scratch.
std::string glbOf(const MeshFile& file, Scratch& scratch, uint64_t& leftOut) {
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
            leftOut = contents.leftOut;
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
  const double error = file.options.stepError;
  const auto fail = [&](std::string message) {
    throw LoadError{{Severity::error, file.path, 0, 0, std::move(message), {}, 0}};
  };
  if (error != 0 && !(error >= leastStepError && error <= mostStepError))
    fail(
        fmt::format("a chord error from {} to {} millimetres was expected for a STEP model, not {}",
                    leastStepError, mostStepError, error));
  Scratch scratch(file.budget);
  std::string glb;
  uint64_t leftOut = 0;
  try {
    glb = glbOf(file, scratch, leftOut);
  } catch (const std::runtime_error& why) {
    fail(fmt::format("this STEP model cannot be read{}: {}",
                     error == 0 ? "" : fmt::format(" with a chord error of {} millimetres", error),
                     why.what()));
  }
  if (leftOut > 0)
    file.locator.warn(nullptr, fmt::format("{} faces of the STEP model are left out: no triangles "
                                           "could be made of them",
                                           leftOut));
  readGltf({glb, file.path, file.locator, file.sink, file.options, file.budget, file.names});
}

} // namespace xvrml
