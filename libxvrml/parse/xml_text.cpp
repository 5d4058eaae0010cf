// xml_text.cpp: decodes texts that are not in UTF-8, and finds long runs of numbers.
#include "parse/xml_text.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace xvrml {
namespace {

constexpr size_t longRun = 4096; // shorter runs cost expat little

// The characters from 0x80 to 0x9f, in which windows-1252 differs from ISO-8859-1.
constexpr uint16_t windows1252[32] = {
    0x20ac, 0x81,   0x201a, 0x192,  0x201e, 0x2026, 0x2020, 0x2021, 0x2c6,  0x2030, 0x160,
    0x2039, 0x152,  0x8d,   0x17d,  0x8f,   0x90,   0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x2dc,  0x2122, 0x161,  0x203a, 0x153,  0x9d,   0x17e,  0x178};

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// Whether a character may stand in a list of numbers. XML gives none of them a meaning inside of
// quotes. Without branches, so that a compiler makes vectors of it.
constexpr bool isOfNumbers(char c) {
  const auto u = static_cast<unsigned char>(c);
  return (static_cast<unsigned char>(u - '0') < 10) | (u == ' ') | (u == '.') | (u == '-') |
         (u == ',') | (u == '+') | ((u | 0x20) == 'e') | (u == '\n') | (u == '\r') | (u == '\t');
}

const char* endOfNumbers(const char* p, const char* end) {
  constexpr ptrdiff_t block = 32;
  while (end - p >= block) {
    int good = 0;
    for (ptrdiff_t i = 0; i < block; ++i) good += isOfNumbers(p[i]);
    if (good < block) break;
    p += block;
  }
  while (p < end && isOfNumbers(*p)) ++p;
  return p;
}

// Writes a character in UTF-8 and returns where it ends.
char* writeUtf8(char* out, uint32_t c) {
  const auto byte = [&](uint32_t value) { *out++ = static_cast<char>(value); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xc0 | (c >> 6));
    byte(0x80 | (c & 0x3f));
  } else if (c < 0x10000) {
    byte(0xe0 | (c >> 12));
    byte(0x80 | ((c >> 6) & 0x3f));
    byte(0x80 | (c & 0x3f));
  } else {
    byte(0xf0 | (c >> 18));
    byte(0x80 | ((c >> 12) & 0x3f));
    byte(0x80 | ((c >> 6) & 0x3f));
    byte(0x80 | (c & 0x3f));
  }
  return out;
}

// A UTF-16 text becomes UTF-8. Half a surrogate pair becomes U+FFFD.
size_t fromUtf16(std::string_view bytes, bool bigEndian, char* out) {
  const char* const start = out;
  const auto unit = [&](size_t i) {
    const auto low = static_cast<unsigned char>(bytes[i + (bigEndian ? 1 : 0)]);
    const auto high = static_cast<unsigned char>(bytes[i + (bigEndian ? 0 : 1)]);
    return uint32_t(high) << 8 | low;
  };
  for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
    uint32_t c = unit(i);
    if (c >= 0xd800 && c < 0xdc00 && i + 3 < bytes.size() && unit(i + 2) >= 0xdc00 &&
        unit(i + 2) < 0xe000) {
      c = 0x10000 + ((c - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
      i += 2;
    } else if (c >= 0xd800 && c < 0xe000) {
      c = 0xfffd;
    }
    out = writeUtf8(out, c);
  }
  return static_cast<size_t>(out - start);
}

// Returns the encoding that an XML declaration names, in upper case; "" if none does.
std::string declaredEncoding(std::string_view text) {
  const size_t end = text.substr(0, 1000).find("?>");
  if (!text.starts_with("<?xml") || end == text.npos) return {};
  const std::string_view declaration = text.substr(0, end);
  const size_t at = declaration.find("encoding");
  if (at == declaration.npos) return {};
  const size_t quote = declaration.find_first_of("\"'", at);
  if (quote == declaration.npos) return {};
  const size_t close = declaration.find(declaration[quote], quote + 1);
  std::string name(declaration.substr(quote + 1, close - quote - 1));
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return name;
}

} // namespace

XmlText::XmlText(std::string_view bytes, const std::string& name, const BudgetPtr& budget)
    : converted_(budget), shortened_(budget) {
  convert(bytes, name);
  hideRuns(name);
}

void XmlText::convert(std::string_view bytes, const std::string& name) {
  text_ = bytes;
  const bool bigEndian =
      bytes.starts_with("\xfe\xff") || bytes.starts_with(std::string_view("\0<", 2));
  const bool littleEndian =
      bytes.starts_with("\xff\xfe") || bytes.starts_with(std::string_view("<\0", 2));
  const auto room = [&](size_t size) {
    char* const out = converted_.grow(size);
    if (!out)
      throw LoadError{
          {Severity::error, name, 0, 0, "its text " + converted_.overLimitText(), {}, 0}};
    return out;
  };
  if (bigEndian || littleEndian) {
    // Two bytes become three at most.
    char* const out = room(bytes.size() / 2 * 3 + 4);
    converted_.keep(
        fromUtf16(bytes.substr(bytes[0] == '<' || bytes[0] == 0 ? 0 : 2), bigEndian, out));
    converted_.fit();
    text_ = converted_.text();
  }
  while (!text_.empty() && isBlank(text_[0])) text_.remove_prefix(1);
  if (bigEndian || littleEndian) {
    encoding_ = "UTF-16";
    return;
  }
  const std::string encoding = declaredEncoding(text_);
  if (!encoding.empty()) encoding_ = encoding;
  if (encoding == "ISO-8859-1" || encoding == "WINDOWS-1252") {
    char* out = room(text_.size() * 3 + 4);
    const char* const start = out;
    const bool windows = encoding == "WINDOWS-1252";
    for (const char c : text_) {
      const auto byte = static_cast<unsigned char>(c);
      const bool differs = windows && byte >= 0x80 && byte < 0xa0;
      out = writeUtf8(out, differs ? windows1252[byte - 0x80] : byte);
    }
    converted_.keep(static_cast<size_t>(out - start));
    converted_.fit();
    text_ = converted_.text();
  } else if (!encoding.empty() && encoding != "UTF-8" && encoding != "US-ASCII") {
    complaint_ = fmt::format("the encoding {} is not known: expected UTF-8, UTF-16, ISO-8859-1 or "
                             "US-ASCII; read as UTF-8",
                             encoding.substr(0, 40));
  }
}

void XmlText::hideRuns(const std::string& name) {
  shortText_ = text_;
  const char* const end = text_.data() + text_.size();
  const char* copied = text_.data();
  size_t size = 0, skipped = 0;
  const auto copyTo = [&](const char* to) {
    const auto count = static_cast<size_t>(to - copied);
    char* const out = shortened_.grow(count);
    if (!out)
      throw LoadError{
          {Severity::error, name, 0, 0, "its text " + shortened_.overLimitText(), {}, 0}};
    std::memcpy(out, copied, count);
    size += count;
    shortened_.keep(size);
  };
  for (const char* p = text_.data(); p < end; ++p) {
    if (*p != '"' && *p != '\'') continue;
    const char* const first = p + 1;
    const char* const last = endOfNumbers(first, end);
    if (last - first < ptrdiff_t(longRun) || last == end || *last != *p) continue;
    copyTo(first);
    runs_.push_back({size, {first, static_cast<size_t>(last - first)}});
    skippedBefore_.push_back(skipped += static_cast<size_t>(last - first));
    copied = last;
    p = last; // the closing quote opens nothing
  }
  if (runs_.empty()) return;
  copyTo(end);
  shortened_.fit();
  shortText_ = shortened_.text();
}

const char* XmlText::place(size_t offset) const {
  // The runs whose place is before the offset. One at the offset follows it.
  const auto after = std::partition_point(runs_.begin(), runs_.end(),
                                          [&](const Run& run) { return run.offset < offset; });
  const size_t skipped =
      after == runs_.begin() ? 0 : skippedBefore_[static_cast<size_t>(after - runs_.begin()) - 1];
  return text_.data() + std::min(offset + skipped, text_.size());
}

std::string_view XmlText::restored(std::string_view part, size_t offset, std::string& whole) const {
  auto run = std::partition_point(runs_.begin(), runs_.end(),
                                  [&](const Run& one) { return one.offset <= offset; });
  if (run == runs_.end() || run->offset >= offset + part.size()) return part;
  whole.clear();
  size_t done = 0;
  for (; run != runs_.end() && run->offset < offset + part.size(); ++run) {
    whole += part.substr(done, run->offset - offset - done);
    whole += run->text;
    done = run->offset - offset;
  }
  whole += part.substr(done);
  return whole;
}

// STag ::= '<' Name (S Attribute)* S? '>', Attribute ::= Name S? '=' S? quote value quote
// (XML 1.0 3.1). expat has read the tag, so it is well-formed.
bool XmlText::findAttributes(std::string_view text, const char* tag, std::vector<Attribute>& out) {
  const char* const end = text.data() + text.size();
  out.clear();
  if (tag >= end || *tag != '<') return false;
  const char* p = tag + 1;
  const auto skipBlanks = [&] {
    while (p < end && isBlank(*p)) ++p;
  };
  const auto word = [&] {
    const char* const from = p;
    while (p < end && !isBlank(*p) && *p != '=' && *p != '>' && *p != '/') ++p;
    return std::string_view(from, static_cast<size_t>(p - from));
  };
  word();
  for (;;) {
    skipBlanks();
    if (p == end || *p == '>' || *p == '/') return p < end;
    const std::string_view name = word();
    skipBlanks();
    if (name.empty() || p == end || *p != '=') return false;
    ++p;
    skipBlanks();
    if (p == end || (*p != '"' && *p != '\'')) return false;
    const char* const value = p + 1;
    const void* const close = std::memchr(value, *p, static_cast<size_t>(end - value));
    if (!close) return false;
    p = static_cast<const char*>(close);
    out.push_back({{name, name.data()}, {value, static_cast<size_t>(p - value)}, value});
    ++p;
  }
}

} // namespace xvrml
