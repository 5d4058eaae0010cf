// errors.cpp: Keeps the errors of calls, and says once of each refused name what to use instead.
#include <utility>

#include "gl/state.h"

namespace rtgl {
namespace {
thread_local std::string lastText;
thread_local std::unique_ptr<State> current;
} // namespace

void fail(GLenum code, std::string text) { throw Failure{code, std::move(text)}; }

void failForVertices() {
  fail(GL_OUT_OF_MEMORY, "a primitive has at most " + std::to_string(maxVertices) + " vertices");
}

void State::record(GLenum code, const std::string& text) {
  if (error_ == GL_NO_ERROR) {
    error_ = code;
    errorText_ = text;
  }
  if (callback_) callback_(code, text.c_str(), user_);
}

void State::refuse(const std::string& name, const std::string& instead) {
  if (refused_.insert(name).second)
    record(GL_INVALID_OPERATION, name + " is not supported: " + instead);
}

GLenum State::takeError() {
  const GLenum error = error_;
  lastText = std::exchange(errorText_, "");
  error_ = GL_NO_ERROR;
  if (error != GL_NO_ERROR) return error;
  const RTenum below = rtGetError();
  if (below != RT_NO_ERROR) lastText = rtGetErrorMessage();
  return below;
}

void State::setErrorCallback(RTerrorCallback callback, void* user) {
  callback_ = callback;
  user_ = user;
}

const char* lastErrorText() { return lastText.c_str(); }

State& state() {
  RTcontext context = rtGetCurrent();
  if (!context) {
    rtInit(nullptr, nullptr);
    context = rtGetCurrent();
    if (!context) fail(GL_INVALID_OPERATION, "no context is current");
  }
  if (!current || current->context() != context) current = std::make_unique<State>(context);
  return *current;
}

void resetState() { current.reset(); }

} // namespace rtgl
