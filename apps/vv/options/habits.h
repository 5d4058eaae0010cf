// habits.h: Gives hints to users who type the syntax or the options of other programs. The hints
// become part of messages about wrong command lines. Pure functions, called while the command line
// is read.
#pragma once

#include <string>
#include <string_view>

namespace vv {

// Returns ": did you mean --size 800x600?" if a size has another program's syntax (800,600;
// 800*600; 800 600; 800); otherwise "".
std::string sizeHint(std::string_view text);

// Returns a sentence that names the equivalent of another program's option (--resolution,
// --sample-count and so on); "" if none is known.
std::string optionHint(std::string_view option);

// Returns what to do with a second file on the command line: it may be a picture to write, or one
// of several worlds.
std::string secondFileHint(const std::string& first, const std::string& second);

} // namespace vv
