// slots.h: the memory that C functions read and write: one slot for each field and event of a
// Script. [the browser's thread]
#pragma once

#include <string>
#include <vector>

#include <xvrml/xscript.h>

namespace native {

// Bytes of an element, as C sees it; 0 for SFString, MFString, SFImage.
size_t elementBytes(XsType type);
// MF types have the SF type of their elements; SF types are their own.
XsType elementType(XsType type);

// A value as plain C arrays, owned. Of nodes it holds numbers that its owner has to retain.
class Slot {
 public:
  Slot() = default;
  explicit Slot(XsType type); // zero, empty
  void copy(const XsValue& from);
  // Room for this many elements (characters of an SFString), all zero.
  void makeRoom(uint32_t elements);
  // What the function wrote, as a value; good until the slot changes. count: elements of an MF
  // type.
  XsValue value(uint32_t count);
  void setText(const char* text);

  void* data();           // elements; for strings const char* const*
  const char* text();     // SFString
  const XsImage* image(); // SFImage
  uint32_t count() const { return count_; }
  XsType type() const { return type_; }

 private:
  void point();
  XsType type_ = XS_SFINT32;
  uint32_t count_ = 1;
  std::vector<uint64_t> words_; // aligned for every type
  std::vector<std::string> texts_;
  std::vector<const char*> pointers_;
  std::vector<XsString> strings_;
  std::vector<uint8_t> pixels_;
  XsImage image_{};
};

} // namespace native
