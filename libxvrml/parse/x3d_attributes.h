// x3d_attributes.h: the attributes of X3D's elements and their values, as the encodings in XML and
// JSON write them (ISO/IEC 19776-1 clause 5, ISO/IEC 19776-5). Numbers go straight from the file
// into the storage of a field. [the thread that loads]
#pragma once

#include <span>
#include <vector>

#include "base/value_parser.h"
#include "parse/sink.h"

namespace xvrml {

struct Attribute {
  Name name;
  // The characters of the value. They are bytes of the file, or live until the element is handled.
  // Lists have no brackets; the strings of an MFString stand in double quotes.
  std::string_view value;
  const char* at = nullptr; // where the value stands in the file
  // The ends of lines and the tabs in it are meant; else they are blanks (XML 1.0 3.3.3).
  bool decoded = false;
};
using Attributes = std::span<const Attribute>;

// Returns the attribute of this name; null if there is none.
const Attribute* findAttribute(Attributes attributes, std::string_view name);
// Returns a text without white space at its ends.
std::string_view trimmed(std::string_view text);
// Returns a text as XML hands it to a program: each end of a line and each tab is a blank.
std::string withBlanks(std::string_view text);

class AttributeReader {
 public:
  // budget: the memory budget of the values; null: memory is not counted.
  AttributeReader(Locator& locator, const Limits& limits, Budget* budget);
  // Reads a value other than nodes into the target. Returns false after a message; the target then
  // has the default of its type.
  bool read(const FieldTarget& target, const Attribute& attribute);
  // Reserves memory. Returns false, after a message, if not enough is left.
  bool reserve(const char* at, uint64_t bytes);

 private:
  bool readString(std::string& out, const Attribute& attribute);
  bool readStrings(const FieldTarget& target, const Attribute& attribute);
  bool readText(const FieldTarget& target, std::string_view text);

  Locator& locator_;
  const Limits& limits_;
  Budget* budget_;
  Lexer lexer_;
  ValueParser values_;
  bool refused_ = false; // the budget has refused memory; reported once
};

} // namespace xvrml
