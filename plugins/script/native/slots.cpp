#include "slots.h"

#include <cstring>

#include <xvrml/xscript_types.h>

namespace native {

XsType elementType(XsType type) { return xsTypeInfo(type)->element; }

size_t elementBytes(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  return info->components > 0 || info->element == XS_SFNODE ? info->bytes : 0;
}

Slot::Slot(XsType type) : type_(type) { makeRoom(xsIsMany(type) ? 0 : 1); }

void Slot::makeRoom(uint32_t elements) {
  count_ = xsIsMany(type_) ? elements : 1;
  const size_t bytes = type_ == XS_SFSTRING ? elements + 1 : elementBytes(type_) * elements;
  // one more word, so that a string that fills the room is terminated
  words_.assign(bytes / sizeof(uint64_t) + 1, 0);
  texts_.assign(elementType(type_) == XS_SFSTRING ? count_ : 0, "");
  pixels_.clear();
  image_ = {};
  point();
}

void Slot::copy(const XsValue& from) {
  type_ = from.type;
  makeRoom(from.count);
  const size_t bytes = elementBytes(type_) * from.count;
  if (bytes > 0) std::memcpy(words_.data(), from.of.data, bytes);
  if (elementType(type_) == XS_SFSTRING)
    for (uint32_t i = 0; i < from.count; ++i)
      texts_[i].assign(from.of.strings[i].data, from.of.strings[i].bytes);
  if (type_ == XS_SFIMAGE) {
    image_ = *from.of.images;
    const size_t size = size_t(image_.width) * size_t(image_.height) * size_t(image_.components);
    if (size > 0) pixels_.assign(image_.pixels, image_.pixels + size);
  }
  point();
}

void Slot::point() {
  pointers_.clear();
  strings_.clear();
  for (const std::string& text : texts_) {
    pointers_.push_back(text.c_str());
    strings_.push_back({text.c_str(), text.size()});
  }
  image_.pixels = pixels_.data();
}

void Slot::setText(const char* text) {
  texts_.assign(1, text);
  point();
}

void* Slot::data() {
  return type_ == XS_MFSTRING ? static_cast<void*>(pointers_.data()) : words_.data();
}
const char* Slot::text() { return texts_.empty() ? "" : texts_[0].c_str(); }
const XsImage* Slot::image() { return &image_; }

XsValue Slot::value(uint32_t count) {
  XsValue value{type_, xsIsMany(type_) ? count : 1, {nullptr}};
  if (elementType(type_) == XS_SFSTRING)
    value.of.strings = strings_.data();
  else if (type_ == XS_SFIMAGE)
    value.of.images = &image_;
  else
    value.of.data = words_.data();
  return value;
}

} // namespace native
