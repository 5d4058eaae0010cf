// language.h: Gives the engine Duktape: its stack API, and what differs between the engines.
#pragma once

#include <duktape.h>

namespace ecma {

constexpr const char* engineText =
    "ECMAScript 5.1 with the objects of ISO/IEC 14772-1 Annex C, on Duktape 2";

} // namespace ecma
