// language.h: Gives the library of the language that the engine is built with (CMakeLists.txt).
#pragma once

#ifdef ECMASCRIPT_QUICKJS
#include "quickjs/language.h"
#else
#include "duktape/language.h"
#endif
