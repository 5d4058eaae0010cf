#include "parse/xml_index.h"

#include <algorithm>

#include "lower_case.h"

namespace xvrml {

void XmlIndex::open(const char* tag, const char* tagEnd, Attributes attributes) {
  XmlElement element;
  element.begin = offset(tag);
  element.tagEnd = offset(tagEnd);
  element.name = {element.begin + 1, text_.find_first_of(" \t\r\n/>", element.begin)};
  element.firstAttribute = attributes_.size();
  element.attributeCount = attributes.size();
  for (const Attribute& one : attributes) {
    const size_t name = offset(one.name.at), value = offset(one.value.data());
    if (attributes_.empty()) quote_ = text_[value - 1];
    attributes_.push_back({{name, name + one.name.text.size()}, {value, value + one.value.size()}});
  }
  const std::string_view name = textOf(element.name);
  if (open_.size() <= 1 && lowerCase(name.substr(name.rfind(':') + 1)) == "scene")
    scene_ = elements_.size();
  open_.push_back(elements_.size());
  elements_.push_back(element);
}

void XmlIndex::close(const char* endTag, const char* end) {
  XmlElement& element = elements_[open_.back()];
  open_.pop_back();
  element.endTag = offset(endTag);
  element.end = offset(end);
}

const XmlElement& XmlIndex::at(size_t begin) const {
  return *std::lower_bound(
      elements_.begin(), elements_.end(), begin,
      [](const XmlElement& element, size_t place) { return element.begin < place; });
}

const XmlAttribute* XmlIndex::find(const XmlElement& element, std::string_view name) const {
  const auto attributes = attributesOf(element);
  const auto found =
      std::find_if(attributes.begin(), attributes.end(),
                   [&](const XmlAttribute& one) { return textOf(one.name) == name; });
  return found == attributes.end() ? nullptr : &*found;
}

const XmlAttribute* XmlIndex::attributeAt(const XmlElement& element, size_t begin) const {
  const auto attributes = attributesOf(element);
  const auto found = std::lower_bound(
      attributes.begin(), attributes.end(), begin,
      [](const XmlAttribute& one, size_t place) { return one.name.begin < place; });
  return found == attributes.end() || found->name.begin != begin ? nullptr : &*found;
}

TextSpan XmlIndex::trimmedValue(const XmlAttribute& attribute) const {
  const std::string_view value = trimmed(textOf(attribute.value));
  const size_t begin = offset(value.data());
  return {begin, begin + value.size()};
}

} // namespace xvrml
