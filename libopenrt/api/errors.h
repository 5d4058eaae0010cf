// errors.h: how a call of the API fails. Inner functions throw; the guard (guard.h) turns what they
// throw into the sticky error of the current context, or of the thread where no context is current.
// Application thread only.
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

// The first error since it was last taken. Texts live in fixed storage: reporting that memory is
// short takes none.
class ErrorState {
 public:
  void record(RTenum code, const char* function, const char* text) noexcept;
  void setCallback(RTerrorCallback callback, void* user) {
    callback_ = callback;
    user_ = user;
  }
  // Returns the error and clears it; its text goes into the thread's last message.
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
