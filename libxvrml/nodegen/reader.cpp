// reader.cpp: reads .node files into a Model. Words, numbers, strings and values have VRML97
// syntax, so the library's lexer and value parser read them. The notation is explained in
// docs/nodegen.md. Called by main once per file.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/value_parser.h"
#include "nodegen/model.h"
#include "nodegen/range.h"
#include "xvrml/numbers.h"

namespace xvrml::nodegen {
namespace {

struct Failed {}; // thrown after an error was reported; caught at the next stanza

bool readFile(const std::string& path, std::string& text) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return false;
  try {
    text.assign(std::istreambuf_iterator<char>(stream), {});
  } catch (const std::ios_base::failure&) { return false; } // a folder, or a read error
  return true;
}

std::string stem(const std::string& path) {
  const size_t slash = path.find_last_of('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  return name.substr(0, name.find_last_of('.'));
}

// Replaces the white space between the words of a value by single blanks.
std::string collapseSpace(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!space)
      result += c;
    else if (!result.empty() && result.back() != ' ')
      result += ' ';
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

// Wide because there is a function for each rule of the notation.
class Reader {
 public:
  Reader(std::string_view text, std::shared_ptr<const std::string> file, Model& model,
         Component& component)
      : locator_(text, std::move(file), model.diagnostics), lexer_(locator_),
        values_(lexer_, limits_), gap_(text.data()), component_(component) {}

  // file ::= "component" string [ "standard" "X3D" ] { stanza | revision | absent }
  void read() {
    try {
      expectWord("component", "the component that the file describes");
      component_.title = readText("its title");
      if (acceptWord("standard")) {
        expectWord("X3D", "the standard of the component, if it is not VRML97");
        component_.ofX3d = true;
      }
    } catch (const Failed&) {} // the stanzas may still be good
    while (!lexer_.peek().is(TokenKind::end)) {
      try {
        readStanza();
      } catch (const Failed&) { skipStanza(); }
    }
    take(); // checks the comments at the end of the file
  }

 private:
  // stanza ::= "abstract" name [ ":" { name } ] string [ "container" name ] [ "{" { field } "}" ]
  //          | name ":" name { name } "{" [ "clause" clause ] [ "container" name ]
  //            [ "lacks" string ] string { field } "}"
  void readStanza() {
    if (acceptWord("since")) return readRevision();
    if (acceptWord("absent")) return readAbsent();
    TypeSpec type;
    type.component = component_.name;
    type.ofX3d = component_.ofX3d;
    type.isAbstract = acceptWord("abstract");
    readName(type.name, type.source,
             type.isAbstract ? "the name of an abstract type" : "the name of a node, or abstract");
    if (acceptWord(":")) {
      do readName(type.parents.emplace_back(), "an abstract type");
      while (lexer_.peek().is(TokenKind::identifier));
    } else if (!type.isAbstract) {
      fail(lexer_.peek(), fmt::format("expected : and the abstract types of {}, found {}",
                                      type.name, describe(lexer_.peek())));
    }
    if (type.isAbstract) {
      type.text = readText("what the abstract type stands for");
      readContainer(type);
    }
    if (!type.isAbstract || lexer_.peek().is(TokenKind::braceOpen)) readBody(type);
    component_.types.push_back(std::move(type));
  }

  void readBody(TypeSpec& type) {
    expect(TokenKind::braceOpen, "{");
    if (!type.isAbstract) {
      if (acceptWord("clause")) type.clause = readClause();
      readContainer(type);
      if (acceptWord("lacks")) type.lacks = readText("what of the node is not done");
      type.text = readText("what the node is");
    }
    while (!lexer_.peek().is(TokenKind::braceClose))
      type.fields.push_back(readField(type.isAbstract));
    take();
  }

  // revision ::= "since" "X3D" version name "{" "clause" clause field { field } "}"
  void readRevision() {
    Revision revision;
    expectWord("X3D", "the standard that differs");
    readVersion(revision);
    readName(revision.node, "the name of a node");
    expect(TokenKind::braceOpen, "{");
    expectWord("clause", "the clause that says so");
    revision.clause = readClause();
    do revision.fields.push_back(readField(false));
    while (!lexer_.peek().is(TokenKind::braceClose));
    take();
    component_.revisions.push_back(std::move(revision));
  }

  // Reads the number of a version: 4, 3.3.
  void readVersion(Revision& revision) {
    const Token token = lexer_.peek();
    const std::string_view text = token.text;
    const bool whole = text.size() == 1, parts = text.size() == 3 && text[1] == '.';
    const auto digit = [&](size_t i) { return text[i] >= '0' && text[i] <= '9'; };
    if (!(whole || parts) || !digit(0) || (parts && !digit(2)))
      fail(token, fmt::format("expected a version of X3D such as 3.3, found {}", describe(token)));
    take();
    revision.major = text[0] - '0';
    if (parts) revision.minor = text[2] - '0';
  }

  // absent ::= "absent" kind string "{" { name clause } "}"
  //          | "absent" kind "of" string string "{" { name } "}"
  void readAbsent() {
    AbsentNode one;
    SourcePosition source;
    readName(one.kind, source, "what the nodes are, such as geometry or sensor");
    if (acceptWord("of")) one.origin = readText("the browser that has the nodes");
    one.loss = readText("what is lost where they are left out");
    expect(TokenKind::braceOpen, "{");
    while (!lexer_.peek().is(TokenKind::braceClose)) {
      readName(one.node, "the name of a node");
      if (one.origin.empty()) one.clause = readClause();
      component_.absent.push_back(one);
    }
    take();
  }

  // Reads the number of a clause: 6.7, 12.4.1. VRML97 has no token for the second form.
  std::string readClause() {
    const Token token = lexer_.peek();
    if (token.text.empty() || token.text.find_first_not_of("0123456789.") != token.text.npos)
      fail(token, fmt::format("expected the number of a clause, found {}", describe(token)));
    return std::string(take().text);
  }

  void readContainer(TypeSpec& type) {
    SourcePosition source;
    if (acceptWord("container")) readName(type.container, source, "the name of a field");
  }

  // field ::= access type name [ value ] [ "#" range ] { attribute }
  FieldSpec readField(bool isAbstract) {
    FieldSpec field;
    const Token access = take();
    if (!accessFromName(access.text, field.access))
      fail(access, fmt::format("expected field, exposedField, eventIn, eventOut or }}, found {}",
                               describe(access)));
    const Token type = take();
    if (!fieldTypeFromName(type.text, field.type))
      fail(type, fmt::format("expected a field type such as SFBool, found {}", describe(type)));
    readName(field.name, field.source, "the name of the field");
    if (!isAbstract && field.hasStorage()) readValue(field);
    readRange(field, isAbstract);
    while (readAttribute(field)) {}
    return field;
  }

  void readValue(FieldSpec& field) {
    const char* const start = lexer_.peek().at();
    field.valueSource = lexer_.place(start);
    if (isWord(lexer_.peek()) || lexer_.peek().is(TokenKind::braceClose))
      fail(lexer_.peek(), fmt::format("expected the default of {}, found {}", field.name,
                                      describe(lexer_.peek())));
    checkComments(start);
    if (!values_.parse(field.type, field.value)) throw Failed();
    gap_ = lexer_.cursor();
    field.valueText = collapseSpace(std::string_view(start, size_t(gap_ - start)));
  }

  // Reads the range from the comment of the field's line, where the standard prints it.
  void readRange(FieldSpec& field, bool isAbstract) {
    const char* p = gap_;
    while (p < lexer_.end() && (*p == ' ' || *p == '\t' || *p == ',')) ++p;
    if (p == lexer_.end() || *p != '#') return;
    const char* const start = ++p;
    while (p < lexer_.end() && *p != '\n' && *p != '\r') ++p;
    const std::string_view comment(start, size_t(p - start));
    if (!looksLikeRange(comment)) return;
    gap_ = p;
    const char* const range = start + comment.find_first_not_of(" \t");
    if (isAbstract)
      failAt(range, "ranges stand with the defaults, in the nodes of the abstract type");
    if (!takesRange(field.type))
      failAt(range, fmt::format("a field of type {} has no range", fieldTypeName(field.type)));
    size_t offset = 0;
    const bool rotation =
        field.type == FieldType::SFRotation || field.type == FieldType::MFRotation;
    const std::string problem = parseRange(comment, rotation, field.range.emplace(), offset);
    if (!problem.empty()) failAt(start + offset, problem);
    field.rangeText = collapseSpace(comment);
    while (field.rangeText.front() == ' ') field.rangeText.erase(0, 1);
  }

  static bool takesRange(FieldType type) {
    return std::visit(
        [](const auto& value) { return Numeric<ElementOf<std::decay_t<decltype(value)>>>; },
        defaultValue(type));
  }

  // attribute ::= "change" kind | "accepts" name { name } | "urls" | "x3d" | "rare" | string
  bool readAttribute(FieldSpec& field) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::string)) {
      if (!field.text.empty()) fail(token, fmt::format("{} is described twice", field.name));
      field.text = readText("what the field is");
      return true;
    }
    if (token.is("change")) {
      if (field.change) fail(token, fmt::format("{} says twice what it changes", field.name));
      take();
      readChange(field);
      return true;
    }
    if (readWord(field, "urls", "holds URLs", field.urls, field.urlsSource) ||
        readWord(field, "x3d", "is X3D's", field.ofX3d, field.ofX3dSource) ||
        readWord(field, "rare", "is rare", field.rare, field.rareSource))
      return true;
    if (!token.is("accepts")) return false;
    if (!field.accepts.empty())
      fail(token, fmt::format("{} says twice what it accepts", field.name));
    take();
    do readName(field.accepts.emplace_back(), "a node or an abstract type");
    while (lexer_.peek().is(TokenKind::identifier) && !isWord(lexer_.peek()));
    return true;
  }

  // Reads a word that stands for itself, if it comes next.
  bool readWord(const FieldSpec& field, std::string_view word, std::string_view says, bool& is,
                SourcePosition& source) {
    const Token token = lexer_.peek();
    if (!token.is(word)) return false;
    if (is) fail(token, fmt::format("{} says twice that it {}", field.name, says));
    take();
    is = true;
    source = lexer_.place(token.at());
    return true;
  }

  void readChange(FieldSpec& field) {
    const Token kind = take();
    Change change = Change::none;
    if (!changeFromName(kind.text, change)) {
      fail(kind, fmt::format("expected none, transform, geometry, appearance, shader, children, "
                             "light, view or time, found {}",
                             describe(kind)));
    }
    field.change = change;
    field.changeSource = lexer_.place(kind.at());
  }

  static bool isWord(const Token& token) {
    Access access = Access::field;
    return token.is(TokenKind::identifier) &&
           (token.text == "change" || token.text == "accepts" || token.text == "urls" ||
            token.text == "x3d" || token.text == "rare" || accessFromName(token.text, access));
  }

  // Reads a name. Names become C++ and Python names, so they have letters, digits and underscores
  // only.
  void readName(std::string& name, SourcePosition& source, std::string_view what) {
    const Token token = take(TokenKind::identifier, what);
    for (const char c : token.text) {
      const bool fits =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
      if (!fits)
        fail(token,
             fmt::format("a name is made of letters, digits and _, unlike {}", describe(token)));
    }
    name = token.text;
    source = lexer_.place(token.at());
  }
  void readName(Reference& reference, std::string_view what) {
    readName(reference.name, reference.source, what);
  }

  std::string readText(std::string_view what) {
    const Token token = take(TokenKind::string, fmt::format("a string: {}", what));
    std::string text = unescape(token.text);
    if (text.empty()) fail(token, fmt::format("expected {}, found an empty string", what));
    // The text becomes a comment in C++ and Python.
    const bool control = std::any_of(text.begin(), text.end(),
                                     [](char c) { return static_cast<unsigned char>(c) < ' '; });
    if (control || text.back() == '\\')
      fail(token, "a description is one line of text that does not end with a backslash");
    return text;
  }

  Token take() {
    const Token token = lexer_.peek();
    checkComments(token.at());
    lexer_.next();
    gap_ = token.at() + token.text.size();
    if (token.is(TokenKind::braceOpen)) ++depth_;
    if (token.is(TokenKind::braceClose)) --depth_;
    return token;
  }

  Token take(TokenKind kind, std::string_view what) {
    const Token token = lexer_.peek();
    if (!token.is(kind)) fail(token, fmt::format("expected {}, found {}", what, describe(token)));
    return take();
  }

  void expect(TokenKind kind, std::string_view what) { take(kind, what); }
  void expectWord(std::string_view word, std::string_view what) {
    if (!acceptWord(word))
      fail(lexer_.peek(),
           fmt::format("expected {}: {}, found {}", word, what, describe(lexer_.peek())));
  }
  bool acceptWord(std::string_view word) {
    if (!lexer_.peek().is(word)) return false;
    take();
    return true;
  }

  // Reports a range in a comment that belongs to no field; it would be ignored silently otherwise.
  void checkComments(const char* to) {
    for (const char* p = gap_; p < to; ++p) {
      if (*p != '#') continue;
      const char* const start = ++p;
      while (p < to && *p != '\n' && *p != '\r') ++p;
      gap_ = p;
      const std::string_view comment(start, size_t(p - start));
      if (looksLikeRange(comment))
        failAt(start + comment.find_first_not_of(" \t"),
               "a range stands on the line of its field's default");
    }
    gap_ = to;
  }

  [[noreturn]] void fail(const Token& token, std::string message) {
    lexer_.error(token.at(), std::move(message));
    throw Failed();
  }
  [[noreturn]] void failAt(const char* at, std::string message) {
    lexer_.error(at, std::move(message));
    throw Failed();
  }

  // Skips the rest of a stanza after an error: continues behind its closing brace, or at the next
  // stanza.
  void skipStanza() {
    const bool inside = depth_ > 0;
    for (Token token = lexer_.peek(); !token.is(TokenKind::end); token = lexer_.peek()) {
      lexer_.next();
      gap_ = token.at() + token.text.size();
      if (token.is(TokenKind::braceOpen)) ++depth_;
      if (token.is(TokenKind::braceClose) && --depth_ <= 0) break;
      if (!inside && depth_ == 0 && lexer_.peek().is("abstract")) break;
    }
    gap_ = lexer_.peek().at();
    depth_ = 0;
  }

  const Limits limits_{};
  Locator locator_;
  Lexer lexer_;
  ValueParser values_;
  const char* gap_; // end of the last token taken; comments after it are not checked yet
  int depth_ = 0;
  Component& component_;
};

} // namespace

bool readSpecification(const std::string& path, bool imported, Model& model) {
  std::string text;
  if (!readFile(path, text)) return false;
  const std::string& kept = model.texts[path] = std::move(text);
  Component& component = model.components.emplace_back();
  component.name = stem(path);
  component.imported = imported;
  Reader(kept, std::make_shared<const std::string>(path), model, component).read();
  return true;
}

} // namespace xvrml::nodegen
