// failure.h: how a call of OpenGL fails. guarded() in state.h records the failure.
#pragma once

#include <string>

#include "openrt/gl_types.h"
#include "openrt/gl_values.h"

namespace rtgl {

struct Failure {
  GLenum code;
  std::string text;
};
[[noreturn]] void fail(GLenum code, std::string text);

} // namespace rtgl
