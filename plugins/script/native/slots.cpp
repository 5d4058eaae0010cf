// slots.cpp: see slots.h.
#include "slots.h"

#include <cstring>

namespace native {

XsType elementType(XsType type) {
  switch (type) {
  case XS_MFCOLOR: return XS_SFCOLOR;
  case XS_MFFLOAT: return XS_SFFLOAT;
  case XS_MFINT32: return XS_SFINT32;
  case XS_MFNODE: return XS_SFNODE;
  case XS_MFROTATION: return XS_SFROTATION;
  case XS_MFSTRING: return XS_SFSTRING;
  case XS_MFTIME: return XS_SFTIME;
  case XS_MFVEC2F: return XS_SFVEC2F;
  case XS_MFVEC3F: return XS_SFVEC3F;
  default: return type;
  }
}

size_t elementBytes(XsType type) {
  switch (elementType(type)) {
  case XS_SFBOOL:
  case XS_SFINT32: return sizeof(int32_t);
  case XS_SFFLOAT: return sizeof(float);
  case XS_SFVEC2F: return 2 * sizeof(float);
  case XS_SFVEC3F:
  case XS_SFCOLOR: return 3 * sizeof(float);
  case XS_SFROTATION: return 4 * sizeof(float);
  case XS_SFTIME: return sizeof(double);
  case XS_SFNODE: return sizeof(XsNode);
  default: return 0;
  }
}

Slot::Slot(XsType type) : type_(type) { makeRoom(type >= XS_MFCOLOR ? 0 : 1); }

void Slot::makeRoom(uint32_t elements) {
  count_ = type_ >= XS_MFCOLOR ? elements : 1;
  const size_t bytes = type_ == XS_SFSTRING ? elements + 1 : elementBytes(type_) * elements;
  words_.assign(bytes / sizeof(uint64_t) + 1, 0); // a text ends even where the room does
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
    for (uint32_t i = 0; i < from.count; ++i) texts_[i].assign(from.of.strings[i].data, from.of.strings[i].bytes);
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

void* Slot::data() { return type_ == XS_MFSTRING ? static_cast<void*>(pointers_.data()) : words_.data(); }
const char* Slot::text() { return texts_.empty() ? "" : texts_[0].c_str(); }
const XsImage* Slot::image() { return &image_; }

XsValue Slot::value(uint32_t count) {
  XsValue value{type_, type_ >= XS_MFCOLOR ? count : 1, {nullptr}};
  if (elementType(type_) == XS_SFSTRING)
    value.of.strings = strings_.data();
  else if (type_ == XS_SFIMAGE)
    value.of.images = &image_;
  else
    value.of.data = words_.data();
  return value;
}

} // namespace native
