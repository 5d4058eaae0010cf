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
  images_.assign(elementType(type_) == XS_SFIMAGE ? count_ : 0, XsImage{});
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
  for (size_t i = 0; i < images_.size(); ++i) {
    const XsImage& image = images_[i] = from.of.images[i];
    const size_t size = size_t(image.width) * size_t(image.height) * size_t(image.components);
    pixels_.emplace_back(image.pixels, image.pixels + size);
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
  for (size_t i = 0; i < pixels_.size(); ++i) images_[i].pixels = pixels_[i].data();
}

void Slot::setText(const char* text) {
  texts_.assign(1, text);
  point();
}

void* Slot::data() {
  if (type_ == XS_MFSTRING) return pointers_.data();
  return images_.empty() ? static_cast<void*>(words_.data()) : images_.data();
}
const char* Slot::text() { return texts_.empty() ? "" : texts_[0].c_str(); }

void Slot::makeBooleans() {
  auto* numbers = reinterpret_cast<int32_t*>(words_.data());
  for (uint32_t i = 0; i < count_; ++i) numbers[i] = numbers[i] != 0;
}

XsValue Slot::value(uint32_t count) {
  XsValue value{type_, xsIsMany(type_) ? count : 1, {nullptr}};
  if (elementType(type_) == XS_SFSTRING)
    value.of.strings = strings_.data();
  else if (elementType(type_) == XS_SFIMAGE)
    value.of.images = images_.data();
  else
    value.of.data = words_.data();
  return value;
}

} // namespace native
