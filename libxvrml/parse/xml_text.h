// xml_text.h: the text of an XML file, in two forms: in UTF-8 as the places of messages count it,
// and without its long runs of numbers for expat, which would copy them. [the thread that loads]
#pragma once

#include <string>
#include <vector>

#include "parse/source.h"
#include "parse/x3d_attributes.h"

namespace xvrml {

class XmlText {
 public:
  // bytes: the file, which must outlive this object. budget: for copies of the text.
  // Throws LoadError if the budget does not allow them.
  XmlText(std::string_view bytes, const std::string& name, const BudgetPtr& budget);

  // Returns the file in UTF-8, from its first element on. It is the file itself, if that is in
  // UTF-8.
  std::string_view text() const { return text_; }
  // Returns the encoding of the file, in upper case: "UTF-8" where it names none.
  const std::string& encoding() const { return encoding_; }
  // Returns why the text may not be what the file means; "" if it is.
  const std::string& complaint() const { return complaint_; }

  // Returns the text that expat reads. A long run of numbers between two quotes is missing in it,
  // with the quotes left. Such a run has no character that means anything to XML.
  std::string_view shortText() const { return shortText_; }
  // Returns the place in text() of an offset in shortText().
  const char* place(size_t offset) const;
  // Returns the part of text() that stands for a part of shortText(), given with its first offset.
  // It is the same unless it has a run of numbers; then it is put together in `whole`.
  std::string_view restored(std::string_view part, size_t offset, std::string& whole) const;

  // Finds the attributes of the tag that begins at `tag` in text(). They are views of the text. A
  // value with a character that XML decodes (&) is left empty. Returns false if no tag is there.
  static bool findAttributes(std::string_view text, const char* tag, std::vector<Attribute>& out);

 private:
  struct Run {
    size_t offset;         // in shortText_, where the run is missing
    std::string_view text; // the run
  };
  void convert(std::string_view bytes, const std::string& name);
  void hideRuns(const std::string& name);

  std::string_view text_, shortText_;
  TextBuffer converted_, shortened_;
  std::vector<Run> runs_;
  std::vector<size_t> skippedBefore_; // bytes of the runs up to each, with it
  std::string encoding_ = "UTF-8";
  std::string complaint_;
};

} // namespace xvrml
