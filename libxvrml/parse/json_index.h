// json_index.h: where the objects, arrays and strings of a JSON text stand. Numbers in arrays are
// not stored, so that the index of a file of big arrays is small. [the thread that loads]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "base/locator.h"

namespace xvrml {

class JsonIndex {
 public:
  struct Value {
    enum class Kind : uint8_t { object, array, string, other } kind;
    bool complete = true;    // the text does not end or go wrong within it
    bool hasStrings = false; // array: one of its elements is a string
    std::string_view key;    // member of an object: its name as written, else empty
    std::string_view text;   // as written, with quotes, braces or brackets
    size_t next = 0;         // index of the value behind this one and all within it
  };
  // Reads a text. Where it is not JSON, or nested too deeply, one error is reported, and the values
  // before it stay. budget: null: memory is not counted.
  JsonIndex(Locator& locator, const BudgetPtr& budget);

  const std::vector<Value>& values() const { return values_; }
  // Calls a function with the index of each value directly within one.
  template <class Function> void eachWithin(size_t outer, Function function) const {
    for (size_t i = outer + 1; i < values_[outer].next; i = values_[i].next) function(i);
  }
  // Returns the first value that begins at this place of the text or behind it. There must be one.
  const Value& from(const char* at) const;
  // Returns whether the text was read to its end.
  bool isWhole() const { return whole_; }
  // Returns the characters of a string value.
  std::string decoded(const Value& string) const;
  // Returns the strings of an array; other elements are left out.
  std::vector<std::string> strings(const Value& array) const;

 private:
  class Reader;
  std::vector<Value> values_; // in the order of their beginnings
  Share share_;
  bool whole_ = false;
};

} // namespace xvrml
