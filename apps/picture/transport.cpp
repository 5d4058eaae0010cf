// transport.cpp: see transport.h.
#include "picture/transport.h"

#include <iterator>

namespace picture {

namespace {
constexpr const char* names[] = {"auto", "direct", "whitted", "path", "light"}; // by RT_TRANSPORT_*
}

std::optional<int> transportNamed(std::string_view name) {
  for (size_t i = 0; i < std::size(names); ++i)
    if (name == names[i]) return int(i);
  return std::nullopt;
}

const char* transportName(RTenum transport) { return transport < std::size(names) ? names[transport] : "plug-in"; }

} // namespace picture
