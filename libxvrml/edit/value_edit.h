// value_edit.h: the text of a value with those of its words changed that differ. Comments,
// separators and lines stay; elements of lists that are new are laid out as those beside them.
// Internal. [one thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edit/value_words.h"
#include "parse/xml_index.h"

namespace xvrml {

// An edit of one text, from the old value, which it has, to the new one. Refers to all of them.
class ValueEdit {
 public:
  ValueEdit(std::string_view text, const ValueSyntax& syntax, const ValueWords& olds,
            const ValueWords& news, const ValueLines& lines)
      : text_(text), syntax_(syntax), olds_(olds), news_(news), lines_(lines) {}

  // Return the new text; nothing if the text has other words than the old value, or no place for
  // the new ones. The first is for values with equally many elements, the second for a list, which
  // has brackets but in XML.
  std::optional<std::string> withWords();
  std::optional<std::string> withElements();

 private:
  bool findElements();
  void append(std::string_view text);
  void copy(size_t end);
  void replaceWords(const TextSpan& part, size_t old, size_t now);

  void remove(size_t old);
  void stripLine(bool withComma);

  void insert(size_t old, size_t first, size_t last);
  void insertBefore(size_t first, size_t last);
  void insertBehind(size_t old, size_t first, size_t last);
  bool fill();
  void appendElement(size_t now, std::string_view within);
  void appendInLine(const TextSpan& elements, std::string_view separator, std::string_view within,
                    bool isFirst);
  bool standsAlone(size_t old) const;
  bool hasComma(size_t old) const;
  bool usesCommas(size_t old) const;
  std::string_view separatorOr(size_t begin, size_t end, std::string_view other) const;
  std::string_view separatorBeside(size_t old) const;
  std::string_view separatorWithin(size_t old) const;
  std::optional<std::string_view> indentationOf(size_t old) const;
  bool startsLine(size_t old) const;
  size_t endOfGap(size_t old) const;

  const std::string_view text_;
  const ValueSyntax& syntax_;
  const ValueWords &olds_, &news_;
  const ValueLines lines_;
  std::vector<TextSpan> elements_; // where those of the old value stand
  std::string out_;
  size_t at_ = 0; // the first byte of the text that is neither copied nor left out
};

} // namespace xvrml
