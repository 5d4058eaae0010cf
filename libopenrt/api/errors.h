// errors.h: errors of API calls. Inner functions throw ApiError; the guard (guard.h) records the
// exception as the sticky error of the current context, or of the thread if no context is current.
// Used on the application's thread only.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "openrt/openrt.h"

namespace openrt {

class ApiError : public std::exception {
 public:
  ApiError(RTenum code, std::string message) : code_(code), message_(std::move(message)) {}
  RTenum code() const { return code_; }
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  RTenum code_;
  std::string message_;
};

[[noreturn]] inline void fail(RTenum code, std::string message) {
  throw ApiError(code, std::move(message));
}
inline void require(bool condition, RTenum code, const char* message) {
  if (!condition) [[unlikely]]
    fail(code, message);
}

// Keeps the first error since the last take(). Texts are in fixed storage, so that reporting an
// out-of-memory error allocates nothing.
class ErrorState {
 public:
  void record(RTenum code, const char* function, const char* text) noexcept;
  void setCallback(RTerrorCallback callback, void* user) {
    callback_ = callback;
    user_ = user;
  }
  // Returns the error and clears it. Its text becomes the thread's last message.
  RTenum take() noexcept;

 private:
  RTenum first_ = RT_NO_ERROR;
  char text_[512] = "";
  RTerrorCallback callback_ = nullptr;
  void* user_ = nullptr;
};

ErrorState& threadErrors() noexcept;
const char* lastErrorMessage() noexcept;

// Records the exception being handled. Called from catch blocks only.
void recordCurrentException(ErrorState& errors, const char* function) noexcept;

} // namespace openrt
