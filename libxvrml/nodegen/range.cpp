// range.cpp: a recursive descent parser for the ranges of fields.
#include "nodegen/range.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace xvrml::nodegen {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class RangeReader {
 public:
  explicit RangeReader(std::string_view text) : text_(text) {}

  // ranges ::= range [ "," range ] [ "or" number ]
  std::string read(bool rotation, FieldRange& range) {
    if (!readInterval(range)) return problem_;
    if (accept(',') && !readAngle(rotation)) return problem_;
    if (acceptWord("or") && !readNumber(range.also)) return problem_;
    skipBlanks();
    if (at_ < text_.size()) return "expected the end of the line after the range";
    return {};
  }

  size_t at() const { return at_; }

 private:
  bool fail(std::string message) {
    problem_ = std::move(message);
    return false;
  }

  void skipBlanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r'))
      ++at_;
  }

  bool accept(char c) {
    skipBlanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool acceptWord(std::string_view word) {
    skipBlanks();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  // range ::= ( "(" | "[" ) number "," number ( ")" | "]" )
  bool readInterval(FieldRange& range) {
    skipBlanks();
    const size_t start = at_;
    if (accept('('))
      range.minimumOpen = true;
    else if (accept('['))
      range.minimumOpen = false;
    else
      return fail("expected ( or [ of a range");
    if (!readNumber(range.minimum)) return false;
    if (!accept(',')) return fail("expected a comma between the ends of the range");
    if (!readNumber(range.maximum)) return false;
    if (accept(')'))
      range.maximumOpen = true;
    else if (accept(']'))
      range.maximumOpen = false;
    else
      return fail("expected ) or ] at the end of the range");
    const bool infinite = (range.minimum == -infinity && !range.minimumOpen) ||
                          (range.maximum == infinity && !range.maximumOpen);
    const bool empty = range.minimum > range.maximum ||
                       (range.minimum == range.maximum && (range.minimumOpen || range.maximumOpen));
    if (!infinite && !empty) return true;
    at_ = start;
    return fail(infinite ? "a range is open at inf: write ( or )" : "the range is empty");
  }

  bool readAngle(bool rotation) {
    skipBlanks();
    const size_t start = at_;
    FieldRange angle;
    if (!readInterval(angle)) return false;
    if (rotation && !angle.bounded()) return true;
    at_ = start;
    return fail(rotation ? "the angle of a rotation is unbounded: expected (-inf,inf)"
                         : "only rotations have two ranges");
  }

  // number ::= [ "-" ] ( "inf" | digits [ "pi" ] | "pi" ) [ "/" digits ]
  bool readNumber(double& out) {
    const bool negative = accept('-');
    if (acceptWord("inf")) {
      out = negative ? -infinity : infinity;
      return true;
    }
    skipBlanks();
    const bool digits = readDigits(out);
    const bool pi = acceptWord("pi");
    if (!digits && !pi) return fail("expected a number, pi or inf");
    if (pi) out = (digits ? out : 1) * std::numbers::pi;
    double divisor = 1;
    if (accept('/') && (!readDigits(divisor) || divisor == 0))
      return fail("expected a number other than 0 after /");
    out = (negative ? -out : out) / divisor;
    return true;
  }

  bool readDigits(double& out) {
    const char* const first = text_.data() + at_;
    const auto [end, error] =
        std::from_chars(first, text_.data() + text_.size(), out, std::chars_format::fixed);
    if (error != std::errc() || !std::isfinite(out)) return false;
    at_ += size_t(end - first);
    return true;
  }

  std::string_view text_;
  size_t at_ = 0;
  std::string problem_;
};

} // namespace

bool looksLikeRange(std::string_view comment) {
  const size_t first = comment.find_first_not_of(" \t");
  return first != std::string_view::npos && (comment[first] == '(' || comment[first] == '[');
}

std::string parseRange(std::string_view comment, bool rotation, FieldRange& range, size_t& offset) {
  RangeReader reader(comment);
  std::string problem = reader.read(rotation, range);
  offset = reader.at();
  return problem;
}

} // namespace xvrml::nodegen
