// habits.h: what people type who know other programs, and what they mean: hints for messages about
// wrong command lines. Pure functions, called while the command line is read.
#pragma once

#include <string>
#include <string_view>

namespace vv {

// Returns ": did you mean --size 800x600?" where a size was written as others write it (800,600;
// 800*600; 800 600; 800); else "".
std::string sizeHint(std::string_view text);

// Returns what serves for an option of another program (--resolution, --samples, ...), a sentence;
// "" where none is known.
std::string optionHint(std::string_view option);

// Returns what to do with a second file on the command line: a picture to be written, or one world
// of several.
std::string secondFileHint(const std::string& first, const std::string& second);

} // namespace vv
