// xml_index.h: where the elements and attributes of an XML text stand, whatever they mean. The
// reader of X3D in XML fills an index for programs that change a part of the text.
// [the thread that loads]
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "parse/x3d_attributes.h"

namespace xvrml {

// A part of a text, in bytes from its beginning.
struct TextSpan {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
};

struct XmlAttribute {
  TextSpan name;
  TextSpan value; // between its quotes
  TextSpan whole() const { return {name.begin, value.end + 1}; }
};

struct XmlElement {
  size_t begin = 0;  // where its start tag begins
  size_t tagEnd = 0; // where its start tag ends
  size_t endTag = 0; // where its end tag begins; its end if it has none
  size_t end = 0;    // where the whole element ends
  size_t firstAttribute = 0, attributeCount = 0;
  TextSpan name;
  // Returns whether it is written <A/>.
  bool isEmptyTag() const { return end == tagEnd; }
};

class XmlIndex {
 public:
  // The reader calls these in the order of the text, which must outlive the index. Pointers are
  // to the first byte of a tag and behind its last one.
  void begin(std::string_view text) { text_ = text; }
  void open(const char* tag, const char* tagEnd, Attributes attributes);
  void close(const char* endTag, const char* end);

  size_t offset(const char* at) const { return size_t(at - text_.data()); }
  // Returns the innermost element that is open. There must be one.
  const XmlElement& innermost() const { return elements_[open_.back()]; }
  // Returns the element that begins at a byte. There must be one.
  const XmlElement& at(size_t begin) const;
  // Returns the Scene of a file, the last one if there are several; null if there is none.
  const XmlElement* scene() const { return scene_ == none ? nullptr : &elements_[scene_]; }
  // Returns the attributes of an element in the order of the text.
  std::span<const XmlAttribute> attributesOf(const XmlElement& element) const {
    return {attributes_.data() + element.firstAttribute, element.attributeCount};
  }
  // Return an attribute by its name or by the place of its name; null if there is none.
  const XmlAttribute* find(const XmlElement& element, std::string_view name) const;
  const XmlAttribute* attributeAt(const XmlElement& element, size_t begin) const;
  // Returns the value of an attribute without white space at its ends.
  TextSpan trimmedValue(const XmlAttribute& attribute) const;
  // Returns the quote around the values of the first attribute of the file.
  char quote() const { return quote_; }

 private:
  static constexpr size_t none = ~size_t(0);
  std::string_view textOf(const TextSpan& span) const {
    return text_.substr(span.begin, span.size());
  }

  std::string_view text_;
  std::vector<XmlElement> elements_; // in the order of their beginnings
  std::vector<XmlAttribute> attributes_;
  std::vector<size_t> open_;
  size_t scene_ = none;
  char quote_ = '\'';
};

} // namespace xvrml
