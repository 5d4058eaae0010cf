// shortage.h: Tells errors of the system that another time may not have: threads, memory or file
// descriptors are short. Stateless; any thread.
#pragma once

#include <exception>
#include <new>
#include <system_error>

// Tells whether an exception means such a shortage.
inline bool isShortage(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) return true;
  const auto* const failed = dynamic_cast<const std::system_error*>(&error);
  if (!failed) return false;
  for (const std::errc shortage :
       {std::errc::resource_unavailable_try_again, std::errc::not_enough_memory,
        std::errc::too_many_files_open, std::errc::too_many_files_open_in_system})
    if (failed->code() == shortage) return true;
  return false;
}
