// assignments.cpp: Rewrites the program's assignments. `v = field` must copy, while `field.x = 1`
// must change the field (C.6.2). ECMAScript's getter cannot tell these apart, but the program's
// text can. If a plain chain of names and indices is assigned, it is
// wrapped in a call that copies. Other text stays unchanged.
#include "assignments.h"

#include <algorithm>
#include <vector>

#include "tokens.h"

namespace ecma {
namespace {

struct Rewriter {
  std::string_view text;
  const std::unordered_set<std::string_view>& objects;
  std::vector<Token> tokens;

  std::string_view word(size_t i) const {
    return text.substr(tokens[i].start, tokens[i].end - tokens[i].start);
  }
  bool is(size_t i, std::string_view what) const { return i < tokens.size() && word(i) == what; }

  // Returns the index after the ] that matches the [ at i; 0 if there is none.
  size_t behindIndex(size_t i) const {
    // Maximum tokens of an index, so that many unclosed brackets do not cause quadratic time.
    constexpr size_t longest = 200;
    size_t depth = 0;
    for (const size_t last = std::min(tokens.size(), i + longest); i < last; ++i) {
      if (tokens[i].kind != Token::Kind::sign) continue;
      const char c = text[tokens[i].start];
      if (c == '[' || c == '(') ++depth;
      if ((c == ']' || c == ')') && --depth == 0) return c == ']' ? i + 1 : 0;
      if (c == '{' || c == '}' || c == ';') return 0;
    }
    return 0;
  }

  // Returns whether a property is a component or another number, and so not an object.
  static bool isNumber(std::string_view property) {
    static constexpr std::string_view names[] = {"x", "y",     "z",      "r",   "g",
                                                 "b", "angle", "length", "comp"};
    return std::find(std::begin(names), std::end(names), property) != std::end(names);
  }

  // Returns the end of the chain that begins at i, if it may name an object of a field; otherwise
  // 0.
  size_t chain(size_t i) const {
    if (i >= tokens.size() || tokens[i].kind != Token::Kind::name || word(i) == "Math") return 0;
    bool object = objects.contains(word(i));
    size_t end = i + 1;
    for (;;) {
      if (is(end, ".") && end + 1 < tokens.size() && tokens[end + 1].kind == Token::Kind::name) {
        object = !isNumber(word(end + 1));
        end += 2;
      } else if (is(end, "[")) {
        end = behindIndex(end);
        if (end == 0) return 0;
        object = true;
      } else {
        break;
      }
    }
    return object && endsExpression(end) ? end : 0;
  }

  bool endsExpression(size_t i) const {
    if (i >= tokens.size()) return true;
    const std::string_view next = word(i);
    if (next == ";" || next == "," || next == ")" || next[0] == '}' || next == "]") return true;
    const bool beginsStatement =
        tokens[i].kind == Token::Kind::name ||
        (tokens[i].kind == Token::Kind::keyword && next != "in" && next != "instanceof");
    return tokens[i].line && beginsStatement;
  }

  std::string rewritten() const {
    std::string out;
    size_t copied = 0;
    for (size_t i = 0; i < tokens.size(); ++i) {
      const bool assigns =
          tokens[i].kind == Token::Kind::sign && (word(i) == "=" || word(i) == "=>");
      const bool returns = is(i, "return") && tokens[i].kind == Token::Kind::keyword &&
                           i + 1 < tokens.size() && !tokens[i + 1].line;
      const size_t end = assigns || returns ? chain(i + 1) : 0;
      if (end == 0) continue;
      out.append(text, copied, tokens[i + 1].start - copied);
      out += "__xvrmlCopy(";
      out.append(text, tokens[i + 1].start, tokens[end - 1].end - tokens[i + 1].start);
      out += ')';
      copied = tokens[end - 1].end;
      i = end - 1;
    }
    return out.append(text, copied);
  }
};

} // namespace

std::string copyAssigned(std::string_view program,
                         const std::unordered_set<std::string_view>& objects) {
  return Rewriter{program, objects, Tokens(program).all()}.rewritten();
}

} // namespace ecma
