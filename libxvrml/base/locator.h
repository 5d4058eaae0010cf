// locator.h: places in a file, and messages about them. Every reader of worlds makes one locator
// for its text. The builder reports through it without knowing how the file is written. [one thread
// per locator]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "xvrml/diagnostics.h"

namespace xvrml {

// A name or a keyword of a file. The text may differ from the bytes of the file, as it does where
// XML writes an entity; `at` is the place of the name in the file's bytes.
struct Name {
  std::string_view text;
  const char* at = nullptr;
};

class Locator {
 public:
  // text: the bytes of the file, which must outlive the locator.
  Locator(std::string_view text, std::shared_ptr<const std::string> file, Diagnostics& diagnostics);

  std::string_view text() const { return {begin_, static_cast<size_t>(end_ - begin_)}; }
  const std::shared_ptr<const std::string>& file() const { return file_; }
  // Returns the line and column (in characters, from 1) of a position in the text. A null position
  // stands for the file as a whole, for example for a binary one: line and column 0. The cost is
  // proportional to the distance from the position of the last call.
  SourcePosition place(const char* at);
  // Sets the position that stands for every one outside of the text, such as those of characters
  // that a reader had to decode.
  void setAnchor(const char* at) { anchor_ = at; }
  void error(const char* at, std::string message) {
    report(Severity::error, at, std::move(message));
  }
  void warn(const char* at, std::string message) {
    report(Severity::warning, at, std::move(message));
  }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  const char* inText(const char* at) const;
  void report(Severity severity, const char* at, std::string message);

  const char* const begin_;
  const char* const end_;
  const std::shared_ptr<const std::string> file_;
  Diagnostics& diagnostics_;
  const char* anchor_;
  // Position of the last call of place(), with its line and column.
  const char* mark_;
  uint32_t line_ = 1, column_ = 1;
};

// Returns the text, or its first 40 bytes and "..."; it is cut between characters.
std::string shortened(std::string_view text);
// The same for a url. One that is no data: url is cut in its middle, and only if it is longer than
// 200 bytes, because its end is the name of the file.
std::string shortenedUrl(std::string_view url);
// Returns the description of a name for messages: 'name'.
std::string describe(const Name& name);

} // namespace xvrml
