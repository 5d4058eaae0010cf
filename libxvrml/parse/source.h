// source.h: the bytes of a world: a mapped file, standard input or memory; unpacked if they are gzipped, and checked to be a
// VRML97 world. Used by the loader, on the thread that loads.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

class Source {
 public:
  // Throws LoadError if there is nothing to read. "-" is standard input.
  static Source open(const std::string& path, const Limits& limits);
  // The bytes must outlive the source unless they are gzipped.
  static Source fromMemory(std::string_view bytes, const std::string& name, const Limits& limits);
  Source(Source&& other) noexcept;
  Source& operator=(Source&&) = delete;
  ~Source();

  // The file's name for the positions of its nodes; openingComments() finds the comments at the top of the file by it.
  std::shared_ptr<const std::string> nameWithComments(const std::string& name) const;

  // The text behind a byte-order mark.
  std::string_view text() const { return text_; }
  // Throws LoadError if this is no VRML97 world; warns if its header is not what it should be (clause 4.2.2, Annex A.2).
  void checkHeader(const std::shared_ptr<const std::string>& file, Diagnostics& diagnostics) const;

 private:
  Source() = default;
  void unpack(const std::string& name, const Limits& limits);

  std::string_view text_;
  std::string owned_;
  std::string damage_; // what is wrong with gzip data of which something could be read
  void* mapping_ = nullptr;
  size_t mappedBytes_ = 0;
  bool byteOrderMark_ = false; // there was one; text_ begins behind it
};

} // namespace xvrml
