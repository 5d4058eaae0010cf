// newer.cpp: Tells what of a program that does not compile is newer than ECMAScript 5.1.
#include <cstdio>
#include <new>

#include "../slots.h"
#include "../tokens.h"

namespace ecma {
namespace {

struct NewerSyntax {
  uint32_t line = 0;  // counted from 1; 0: nothing was found
  char what[10] = ""; // "=>", "let"
};

// Words that begin something newer than ECMAScript 5.1 where a name follows on the same line.
bool isNewWord(std::string_view word) {
  static constexpr std::string_view words[] = {"let",    "class",  "async",
                                               "import", "export", "yield"};
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

struct Search {
  std::string_view text;
  std::vector<Token> tokens;

  std::string_view word(size_t i) const {
    return i < tokens.size() ? text.substr(tokens[i].start, tokens[i].end - tokens[i].start)
                             : std::string_view();
  }
  bool opens(size_t i) const { return word(i) == "{" || word(i) == "["; }
  bool continues(size_t i) const { // something follows on the same line that may be declared
    if (i + 1 >= tokens.size() || tokens[i + 1].line) return false;
    return isNameStart(word(i + 1)[0]) || opens(i + 1) || word(i + 1) == "*";
  }
  bool isNewSign(size_t i) const {
    const std::string_view it = word(i), next = word(i + 1);
    return it == "=>" || (it == "." && next == "." && word(i + 2) == ".") ||
           (it == "?" && (next == "." || next == "?"));
  }
  bool isNew(size_t i) const {
    switch (tokens[i].kind) {
    case Token::Kind::sign: return isNewSign(i);
    case Token::Kind::literal: return word(i)[0] == '`';
    case Token::Kind::keyword: return (word(i) == "const" || word(i) == "var") && opens(i + 1);
    case Token::Kind::name:
      if (word(i) == "of") return i > 0 && tokens[i - 1].kind == Token::Kind::name;
      return isNewWord(word(i)) && continues(i) && (i == 0 || word(i - 1) != ".");
    default: return false;
    }
  }
  // Returns the text of what begins at token i.
  std::string_view spelled(size_t i) const {
    const char c = word(i)[0];
    if (c == '`') return "`";
    if (c == '.') return "...";
    if (c == '?') return word(i + 1) == "." ? "?." : "??";
    if (tokens[i].kind == Token::Kind::keyword) return word(i + 1) == "{" ? "var {" : "var [";
    return word(i);
  }
};

NewerSyntax findNewer(std::string_view program) {
  const Search search{program, Tokens(program).all()};
  NewerSyntax found;
  for (size_t i = 0; i < search.tokens.size(); ++i) {
    if (!search.isNew(i)) continue;
    const auto before = program.substr(0, search.tokens[i].start);
    found.line = uint32_t(1 + std::count(before.begin(), before.end(), '\n'));
    const std::string_view what = search.spelled(i);
    std::snprintf(found.what, sizeof found.what, "%.*s", int(what.size()), what.data());
    break;
  }
  return found;
}

} // namespace

uint32_t explainSyntax(duk_context* ctx, const Interpreter& self) {
  if (duk_get_error_code(ctx, -1) != DUK_ERR_SYNTAX_ERROR) return 0;
  NewerSyntax newer;
  try {
    newer = findNewer({self.info->text.data, self.info->text.bytes});
  } catch (const std::bad_alloc&) {} // the engine's own words have to do
  if (newer.line == 0) return 0;
  duk_push_sprintf(ctx, "SyntaxError: '%s' is newer than ECMAScript 5.1, which this engine runs",
                   newer.what);
  duk_replace(ctx, -2);
  return newer.line;
}

} // namespace ecma
