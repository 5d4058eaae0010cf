// errors.cpp: Finds the place of an error in a program. Tcl counts lines within the body of a
// procedure; its trace names the active procedures, innermost first. [the browser's thread]
#include <algorithm>
#include <charconv>
#include <cstring>

#include "interpreter.h"

namespace tclscript {
namespace {

uint32_t lineAt(std::string_view text, size_t at) {
  return 1 + uint32_t(std::count(text.begin(), text.begin() + long(at), '\n'));
}

bool isWordBreak(char c) { return std::strchr(" \t\n;{}[]\"", c) != nullptr; }

std::string_view tail(std::string_view name) {
  const size_t colons = name.rfind("::");
  return colons == name.npos ? name : name.substr(colons + 2);
}

// Returns the line on which the body of a procedure begins. Searches `proc NAME ARGUMENTS BODY`
// anywhere in the program; 0: not found.
uint32_t bodyLine(std::string_view program, std::string_view name) {
  constexpr int maxCandidates = 200;
  int candidates = 0;
  for (size_t at = program.find("proc"); at != program.npos && candidates < maxCandidates;
       at = program.find("proc", at + 4)) {
    if ((at > 0 && !isWordBreak(program[at - 1])) || at + 4 >= program.size() ||
        !std::strchr(" \t", program[at + 4]))
      continue;
    const size_t word = program.find_first_not_of(" \t", at + 4);
    if (word == program.npos) break;
    size_t end = word;
    while (end < program.size() && !isWordBreak(program[end])) ++end;
    if (tail(program.substr(word, end - word)) != tail(name)) continue;
    ++candidates;
    Tcl_Parse parse;
    if (Tcl_ParseCommand(nullptr, program.data() + at, int(program.size() - at), 0, &parse) !=
        TCL_OK)
      continue;
    uint32_t line = 0;
    if (parse.numWords == 4) {
      const Tcl_Token* token = parse.tokenPtr;
      for (int i = 0; i < 3; ++i) token += token->numComponents + 1;
      line = lineAt(program, size_t(token->start - program.data()));
    }
    Tcl_FreeParse(&parse);
    if (line) return line;
  }
  return 0;
}

} // namespace

ErrorPlace errorPlace(std::string_view program, std::string_view trace, std::string_view script,
                      int errorLine) {
  constexpr std::string_view opening = "(procedure \"", middle = "\" line ";
  for (size_t at = trace.find(opening); at != trace.npos; at = trace.find(opening, at + 1)) {
    const size_t name = at + opening.size(), end = trace.find(middle, name);
    if (end == trace.npos) break;
    int line = 0;
    std::from_chars(trace.data() + end + middle.size(), trace.data() + trace.size(), line);
    const std::string_view procedure = trace.substr(name, end - name);
    if (const uint32_t first = bodyLine(program, procedure); first && line > 0)
      return {first + uint32_t(line) - 1, std::string(tail(procedure))};
  }
  if (script.empty()) return {};
  const size_t at = program.find(script);
  if (at == program.npos) return {};
  return {lineAt(program, at) + uint32_t(std::max(errorLine, 1)) - 1, ""};
}

} // namespace tclscript
