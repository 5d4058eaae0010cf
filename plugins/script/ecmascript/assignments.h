// assignments.h: Implements the value semantics of C.6.2 in a language whose variables are
// references: a value assigned from a field, an eventOut or an element of an MF object is a copy.
// [the browser's thread]
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace ecma {

// Rewrites `= field`, `= list[i]`, `= node.field` and `return` of such expressions to `=
// __xvrmlCopy(field)`; line numbers stay the same. objects: names of the Script's fields and
// eventOuts whose values are objects.
std::string copyAssigned(std::string_view program,
                         const std::unordered_set<std::string_view>& objects);

} // namespace ecma
