// source.h: the bytes of a world: a mapped file, standard input or memory; unpacked if they are
// gzipped, and checked to be a VRML97 world. Used by the loader, on the thread that loads.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "base/budget.h"
#include "xvrml/world.h"

namespace xvrml {

// A text that grows in place: realloc() moves pages, so that it never takes twice its size. What it
// takes is drawn from a budget.
class HeldText {
 public:
  explicit HeldText(BudgetPtr budget) : share_(std::move(budget)) {}
  // Room for more bytes behind those that are there; null if the budget has not enough left. Throws
  // std::bad_alloc.
  char* grow(size_t more);
  // So many bytes are there now.
  void keep(size_t size) { size_ = size; }
  // Gives back what is not used.
  void fit();
  std::string_view text() const { return {bytes_.get(), size_}; }
  // "takes ... more than limit worldBytes=N", for messages.
  std::string tooMuch() const;

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<char, Free> bytes_;
  size_t size_ = 0;
  Share share_; // of as many bytes as there is room for
};

class Source {
 public:
  // budget: of the world, for the text while the source holds it; null: it is not counted. What is
  // mapped from a file is not. Throws LoadError if there is nothing to read, or more than the
  // budget allows. "-" is standard input.
  static Source open(const std::string& path, const Limits& limits, const BudgetPtr& budget);
  // The bytes must outlive the source unless they are gzipped.
  static Source fromMemory(std::string_view bytes, const std::string& name, const Limits& limits,
                           const BudgetPtr& budget);
  Source(Source&& other) noexcept;
  Source& operator=(Source&&) = delete;
  ~Source();

  // The file's name for the positions of its nodes; openingComments() finds the comments at the top
  // of the file by it.
  std::shared_ptr<const std::string> nameWithComments(const std::string& name) const;

  // The text behind a byte-order mark.
  std::string_view text() const { return text_; }
  // Throws LoadError if this is no VRML97 world; warns if its header is not what it should be
  // (clause 4.2.2, Annex A.2).
  void checkHeader(const std::shared_ptr<const std::string>& file, Diagnostics& diagnostics) const;

 private:
  explicit Source(const BudgetPtr& budget) : held_(budget) {}
  void unpack(const std::string& name, const Limits& limits, const BudgetPtr& budget);

  std::string_view text_;
  HeldText held_;
  std::string damage_; // what is wrong with gzip data of which something could be read
  void* mapping_ = nullptr;
  size_t mappedBytes_ = 0;
  bool byteOrderMark_ = false; // there was one; text_ begins behind it
};

} // namespace xvrml
