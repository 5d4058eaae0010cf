// value_parser.h: parses field values (ISO/IEC 14772-1 clause 5) from text into typed storage. Used
// by the file parser, which reads big arrays straight into a node's vectors, and by nodegen for
// defaults. [the lexer's thread]
#pragma once

#include <functional>

#include "base/budget.h"
#include "base/lexer.h"
#include "xvrml/limits.h"
#include "xvrml/numbers.h"

namespace xvrml {

class ValueParser {
 public:
  // budget: the memory budget of the values; null: memory is not counted.
  ValueParser(Lexer& lexer, const Limits& limits, Budget* budget = nullptr)
      : lexer_(lexer), limits_(limits), budget_(budget) {}

  // Reads true and false as X3D writes them, too, without a warning.
  void acceptLowerCase() { lowerCase_ = true; }

  // Lets a list keep what can be read of it: an element that cannot be read costs that element
  // only, as do numbers that are left over. All is reported as before. endsList: returns whether a
  // word in a list begins what follows the list, as the name of a field does; null: no word does.
  void keepElements(std::function<bool(const Token&)> endsList) {
    keepsElements_ = true;
    endsList_ = std::move(endsList);
  }

  // Reads a value into *storage, whose C++ type must be that of `type`. SFNode accepts only NULL
  // and MFNode only [ ]; the file parser reads nodes. Returns false after it has reported an error.
  // The lexer then stands at or behind the error, and the storage is unspecified.
  bool parse(FieldType type, void* storage);
  bool parse(FieldType type, Value& value);
  // Does the same with a value that is the lexer's whole text, as the encodings in XML and JSON
  // have it: lists have no brackets.
  bool parseAll(FieldType type, void* storage);

 private:
  template <class T> bool multiple(std::vector<T>& out);
  template <class T> bool elements(std::vector<T>& out);
  template <class T> bool elementsUpToEnd(std::vector<T>& out);
  template <class T> void reserve(std::vector<T>& out, const char* from, const char* to);
  bool single(bool& out);
  bool single(std::string& out);
  bool single(Image& out);
  bool single(NodeRef& out);
  template <Numeric T> bool single(T& out);
  // Says how a list goes on behind a number or a string that cannot be read.
  enum class AfterFault : uint8_t {
    next,      // it is passed, and the list goes on
    listEnds,  // the list ends before it
    unreadable // neither
  };
  AfterFault passFault(const char* at);
  bool passElement(const char* at);
  bool htmlColor(Color& out);
  template <class Scalar> bool scalar(const char*& p, Scalar& out, FieldType type);
  bool take(const char* at, uint64_t bytes);
  bool fail(const char* at, std::string message);
  bool failFound(const Token& found, std::string_view expected);

  Lexer& lexer_;
  const Limits& limits_;
  Budget* budget_;
  bool lowerCase_ = false;
  bool wholeText_ = false; // the value ends with the text
  bool refused_ = false;   // the budget has refused memory; reported once
  bool keepsElements_ = false;
  std::function<bool(const Token&)> endsList_;
  // These belong to the list that is being read:
  uint64_t faults_ = 0;          // elements that cannot be read; the first is reported in its place
  const char* second_ = nullptr; // the second of them
  bool listEnded_ = false;       // the list has ended without its bracket, which is reported
};

// Returns the characters that a string token stands for. \" and \\ are unescaped; other backslashes
// stay (clause 5.9).
std::string unescape(std::string_view token);

} // namespace xvrml
