// messages.h: how rtut tells errors: on stderr, because programs for GLUT have no other place.
#pragma once

#include <string>

namespace rtut {

void complain(const std::string& text);

} // namespace rtut
