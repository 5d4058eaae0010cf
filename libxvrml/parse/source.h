// source.h: the bytes of a world: a mapped file, standard input or memory. They are unpacked if
// they are gzipped, and checked to be a VRML97 world. Used by the loader, on the thread that loads.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "base/budget.h"
#include "base/globe.h"
#include "xvrml/world.h"

namespace xvrml {

// A text buffer that grows in place: realloc() moves pages, so that growing never needs twice the
// size. Its memory is reserved from a budget.
class TextBuffer {
 public:
  explicit TextBuffer(BudgetPtr budget) : share_(std::move(budget)) {}
  // Returns space for more bytes behind the present ones; null if the budget has not enough left.
  // Throws std::bad_alloc.
  char* grow(size_t more);
  // Sets the number of bytes that the buffer contains.
  void keep(size_t size) { size_ = size; }
  // Releases unused capacity.
  void fit();
  std::string_view text() const { return {bytes_.get(), size_}; }
  // Returns "takes ... more than limit worldBytes=N", for messages.
  std::string overLimitText() const;

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<char, Free> bytes_;
  size_t size_ = 0;
  Share share_; // reservation of the buffer's capacity
};

// Returns the name of a file for the positions of its nodes. depth: number of files around it:
// those of Inlines, and those whose Scripts have created or loaded it.
std::shared_ptr<const std::string> fileName(const std::string& name, uint64_t depth);
// Returns that depth; 0 for other names and for null.
uint64_t fileDepth(const std::shared_ptr<const std::string>& file);
// Return and set the version of the standard that the file of this name follows; VRML97 for other
// names and for null.
FileVersion fileVersion(const std::shared_ptr<const std::string>& file);
void setFileVersion(const std::shared_ptr<const std::string>& file, const FileVersion& version);
// Sets the comments at the top of the file of this name (openingComments()), each with an end of
// line. Source finds those of other encodings than JSON. Only the first 4096 bytes are kept.
void setOpeningComments(const std::shared_ptr<const std::string>& file, std::string comments);
// Return and set the metres in the unit of lengths of the file of this name; 1 for other names.
double lengthUnit(const std::shared_ptr<const std::string>& file);
void setLengthUnit(const std::shared_ptr<const std::string>& file, double metres);

// Return and set what the places on a globe in the world of the file of this name count from; null
// for other names.
GlobeOriginPtr globeOrigin(const std::shared_ptr<const std::string>& file);
void setGlobeOrigin(const std::shared_ptr<const std::string>& file, GlobeOriginPtr origin);

// Tells a file that has been written to since from one that has not; all 0: no file.
struct FileStamp {
  int64_t seconds = 0, nanoseconds = 0, bytes = 0;
  uint64_t number = 0;
  bool operator==(const FileStamp&) const = default;
};
// Returns the stamp of a file as it is now.
FileStamp stampOf(const std::string& path);
// Returns the stamp that the file of this name had when its world was loaded.
FileStamp fileStamp(const std::shared_ptr<const std::string>& file);

// Returns a text without what old systems put behind its end: the byte 0x1A, zeros up to the end of
// a disk's sector, and the blanks around these.
std::string_view withoutDosEnd(std::string_view text);

class Source {
 public:
  // Opens a file; "-" is standard input. budget: the world's budget, for the text that the source
  // stores; null: it is not counted. A mapped file is not counted. Throws LoadError if nothing can
  // be read, or more than the budget allows.
  static Source open(const std::string& path, const Limits& limits, const BudgetPtr& budget);
  // Opens a text in memory. The bytes must outlive the source unless they are gzipped.
  static Source fromMemory(std::string_view bytes, const std::string& name, const Limits& limits,
                           const BudgetPtr& budget);
  Source(Source&& other) noexcept;
  Source& operator=(Source&&) = delete;
  ~Source();

  // Returns the file name for the positions of its nodes. openingComments() finds the comments at
  // the top of the file through it.
  // depth: see fileName().
  std::shared_ptr<const std::string> nameWithComments(const std::string& name,
                                                      uint64_t depth) const;

  // Returns the text after a byte-order mark.
  std::string_view text() const { return text_; }
  // Return what the bytes of the file have beside the text.
  bool isPacked() const { return packed_; } // gzip
  bool hasByteOrderMark() const { return byteOrderMark_; }
  bool isUtf16() const { return utf16_; }
  const FileStamp& stamp() const { return stamp_; }
  // Finds out what the file is: by its content or, where that says nothing, by its suffix. The name
  // `file` then carries the version (fileVersion). Throws LoadError if this is no world that can be
  // read. Warns if its header is not exact (ISO/IEC 14772-1 4.2.2, ISO/IEC 19776-2 4.3.2.2).
  void identify(const std::shared_ptr<const std::string>& file, Diagnostics& diagnostics) const;

 private:
  explicit Source(const BudgetPtr& budget) : buffer_(budget) {}
  FileVersion version(const std::shared_ptr<const std::string>& file,
                      Diagnostics& diagnostics) const;
  void unpack(const std::string& name, const Limits& limits, const BudgetPtr& budget);

  std::string_view text_;
  TextBuffer buffer_;
  std::string damage_; // error in gzip data that could be read in part
  void* mapping_ = nullptr;
  size_t mappedBytes_ = 0;
  FileStamp stamp_;
  bool packed_ = false;
  bool byteOrderMark_ = false; // the text began with a byte-order mark, which text_ leaves out
  bool utf16_ = false;         // the bytes were in UTF-16, and text_ is their UTF-8
};

} // namespace xvrml
