// slots.h: Owns the memory that C functions read and write: one slot for each field and event of a
// Script. [the browser's thread]
#pragma once

#include <string>
#include <vector>

#include <xvrml/xscript.h>

namespace native {

// Returns the bytes of an element in C; 0 for SFString, MFString, SFImage.
size_t elementBytes(XsType type);
// Returns the SF type of an MF type's elements; an SF type returns itself.
XsType elementType(XsType type);

// A value stored as plain C arrays, which it owns. Nodes are stored as numbers, which the owner
// must retain.
class Slot {
 public:
  Slot() = default;
  explicit Slot(XsType type); // makes a zero or empty value
  void copy(const XsValue& from);
  // Makes room for this many elements (characters of an SFString), all zero.
  void makeRoom(uint32_t elements);
  // Returns what the function wrote as a value, valid until the slot changes. count: elements of an
  // MF type.
  XsValue value(uint32_t count);
  void setText(const char* text);

  void makeBooleans(); // makes 1 of every number but 0

  void* data();       // returns the elements; for strings, const char* const*
  const char* text(); // returns the text of an SFString
  uint32_t count() const { return count_; }
  XsType type() const { return type_; }

 private:
  void point();
  XsType type_ = XS_SFINT32;
  uint32_t count_ = 1;
  std::vector<uint64_t> words_; // uint64_t is aligned for every type
  std::vector<std::string> texts_;
  std::vector<const char*> pointers_;
  std::vector<XsString> strings_;
  std::vector<std::vector<uint8_t>> pixels_; // the pixels of each image
  std::vector<XsImage> images_;
};

} // namespace native
