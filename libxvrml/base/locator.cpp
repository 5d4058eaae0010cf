// locator.cpp: finds lines and columns, and cuts out the line that a message shows.
#include "base/locator.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

namespace xvrml {
namespace {

constexpr bool isContinuationByte(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

uint32_t countCharacters(const char* from, const char* to) {
  return static_cast<uint32_t>(
      std::count_if(from, to, [](char c) { return !isContinuationByte(c); }));
}

// Returns the number of line ends (LF, CR or CR LF) in [from, to). Blocks are small enough for byte
// sums, so that compilers vectorise the loop.
uint32_t countLines(const char* from, const char* to, const char* end) {
  if (from < to && to == end)
    // to[0] cannot be read.
    return countLines(from, to - 1, end) + (to[-1] == '\n' || to[-1] == '\r');
  uint32_t lines = 0;
  while (from < to) {
    const ptrdiff_t block = std::min<ptrdiff_t>(to - from, 240);
    uint8_t sum = 0;
    for (ptrdiff_t i = 0; i < block; ++i)
      sum += (from[i] == '\n') | ((from[i] == '\r') & (from[i + 1] != '\n'));
    lines += sum;
    from += block;
  }
  return lines;
}

const char* startOfLine(const char* p, const char* begin, const char* end) {
  while (p > begin && p[-1] != '\n' && !(p[-1] == '\r' && (p == end || *p != '\n'))) --p;
  return p;
}

const char* endOfLine(const char* p, const char* end) {
  while (p < end && *p != '\n' && *p != '\r') ++p;
  return p;
}

} // namespace

Locator::Locator(std::string_view text, std::shared_ptr<const std::string> file,
                 Diagnostics& diagnostics)
    : begin_(text.data()), end_(text.data() + text.size()), file_(std::move(file)),
      diagnostics_(diagnostics), anchor_(text.data()), mark_(text.data()) {}

const char* Locator::inText(const char* at) const {
  constexpr std::less<const char*> before; // compares pointers into different texts, too
  return at && (before(at, begin_) || before(end_, at)) ? anchor_ : at;
}

SourcePosition Locator::place(const char* at) {
  at = inText(at);
  if (!at) return {file_, 0, 0};
  const char* from = std::min(at, mark_);
  const char* to = std::max(at, mark_);
  const uint32_t lines = countLines(from, to, end_);
  line_ = at >= mark_ ? line_ + lines : line_ - lines;
  if (lines > 0) {
    column_ = countCharacters(startOfLine(at, begin_, end_), at) + 1;
  } else {
    const uint32_t characters = countCharacters(from, to);
    column_ = at >= mark_ ? column_ + characters : column_ - characters;
  }
  mark_ = at;
  return {file_, line_, column_};
}

void Locator::report(Severity severity, const char* at, std::string message) {
  at = inText(at);
  if (!diagnostics_.keeps(severity)) { // it is only counted, so its line is not needed
    diagnostics_.add({severity, {}, 0, 0, {}, {}, 0});
    return;
  }
  if (!at) {
    diagnostics_.add({severity, file_ ? *file_ : std::string(), 0, 0, std::move(message), {}, 0});
    return;
  }
  const SourcePosition where = place(at);
  // A very long line is shown as a window around the position, cut between characters.
  constexpr ptrdiff_t before = 100, after = 80;
  const char* from = startOfLine(at, at - begin_ > before ? at - before : begin_, end_);
  while (from < at && isContinuationByte(*from)) ++from;
  const char* to = endOfLine(at, end_ - at > after ? at + after : end_);
  while (to < end_ && to > at && isContinuationByte(*to)) --to;
  diagnostics_.add({severity, file_ ? *file_ : std::string(), where.line, where.column,
                    std::move(message), std::string(from, to), countCharacters(from, at) + 1});
}

std::string shortened(std::string_view text) {
  constexpr size_t shown = 40;
  if (text.size() <= shown) return std::string(text);
  size_t cut = shown;
  while (cut > 0 && isContinuationByte(text[cut])) --cut;
  return fmt::format("{}...", text.substr(0, cut));
}

std::string shortenedUrl(std::string_view url) {
  constexpr size_t shown = 200, behind = 160;
  if (url.starts_with("data:")) return shortened(url);
  if (url.size() <= shown) return std::string(url);
  size_t end = url.size() - behind;
  while (end < url.size() && isContinuationByte(url[end])) ++end;
  return shortened(url) + std::string(url.substr(end));
}

std::string describe(const Name& name) {
  if (name.text.size() == 1 && static_cast<unsigned char>(name.text[0]) < 0x20)
    return fmt::format("the control character 0x{:02x}", static_cast<unsigned>(name.text[0]));
  return fmt::format("'{}'", shortened(name.text));
}

} // namespace xvrml
