// assignments.h: C.6.2 in a language whose variables refer to objects: what is assigned from a
// field, an eventOut or an element of an MF object is a value of its own. See assignments.cpp. [the
// browser's thread]
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace ecma {

// The program with `= field`, `= list[i]`, `= node.field` and `return` of such as `=
// __xvrmlCopy(field)`; the lines stay the same. objects: names of the Script's fields and eventOuts
// whose values are objects.
std::string copyAssigned(std::string_view program,
                         const std::unordered_set<std::string_view>& objects);

} // namespace ecma
