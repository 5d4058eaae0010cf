// errors.cpp: Keeps the sticky error and translates exceptions into error codes. Runs on the
// application's thread.
#include "api/errors.h"

#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>

#include "backend/backend.h"
#include "openrt/sums.h"
#include "scene/sums_error.h"
#include "shortage.h"

namespace openrt {
namespace {
thread_local char lastMessage[512] = "";
}

void ErrorState::record(RTenum code, const char* function, const char* text) noexcept {
  char message[sizeof(text_)];
  std::snprintf(message, sizeof(message), "%s: %s", function, text);
  if (first_ == RT_NO_ERROR) {
    first_ = code;
    std::memcpy(text_, message, sizeof(message));
  }
  if (!callback_) return;
  try {
    callback_(code, message, user_);
  } catch (...) { // an exception of the application must not cross the C interface
  }
}

RTenum ErrorState::take() noexcept {
  const RTenum code = first_;
  std::memcpy(lastMessage, text_, sizeof(text_));
  first_ = RT_NO_ERROR;
  text_[0] = '\0';
  return code;
}

ErrorState& threadErrors() noexcept {
  thread_local ErrorState errors;
  return errors;
}

const char* lastErrorMessage() noexcept { return lastMessage; }

void recordCurrentException(ErrorState& errors, const char* function) noexcept {
  try {
    throw;
  } catch (const ApiError& e) {
    errors.record(e.code(), function, e.what());
  } catch (const std::bad_alloc&) {
    errors.record(RT_OUT_OF_MEMORY, function, "out of memory");
  } catch (const std::length_error&) {
    errors.record(RT_OUT_OF_MEMORY, function, "more elements than an array can hold");
  } catch (const ClusterError& e) {
    errors.record(RT_CLUSTER_ERROR, function, e.what());
  } catch (const SumsError& e) {
    errors.record(RT_SUMS_ERROR, function, e.what());
  } catch (const OptionError& e) {
    errors.record(RT_INVALID_VALUE, function, e.what());
  } catch (const std::system_error& e) {
    // A thread cannot be started, for example.
    errors.record(isShortage(e) ? RT_OUT_OF_MEMORY : RT_IO_ERROR, function, e.what());
  } catch (const std::exception& e) {
    errors.record(RT_INVALID_OPERATION, function, e.what());
  } catch (...) { errors.record(RT_INVALID_OPERATION, function, "an unknown exception"); }
}

} // namespace openrt
