// messages.h: how rtut tells errors: on stderr, because programs for GLUT have no other place.
#pragma once

#include <exception>
#include <new>
#include <string_view>

namespace rtut {

void complain(std::string_view text) noexcept;
void complain(const char* function, const char* text) noexcept;

// Runs the body of a function. Exceptions, which must not leave a C function, become messages.
// Returns false then.
template <class Body> bool guarded(const char* function, Body&& body) noexcept {
  try {
    body();
    return true;
  } catch (const std::bad_alloc&) {
    complain(function, "not enough memory");
  } catch (const std::exception& error) { complain(function, error.what()); } catch (...) {
    complain(function, "an exception without a text");
  }
  return false;
}

} // namespace rtut
