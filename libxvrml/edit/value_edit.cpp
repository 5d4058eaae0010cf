#include "edit/value_edit.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "base/lexer.h"
#include "edit/alignment.h"
#include "edit/lines.h"

namespace xvrml {
namespace {

constexpr size_t lineWidth = 120;

bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

// Calls visit(token) for the tokens of a value's text, without brackets, until it returns false.
template <class Visit>
void forEachToken(std::string_view text, const ValueSyntax& syntax, const Visit& visit) {
  Diagnostics none;
  none.limit = 0;
  Locator locator(text, nullptr, none);
  Lexer lexer(locator);
  if (syntax.isXml()) lexer.enter(text);
  for (Token token = lexer.next(); !token.is(TokenKind::end); token = lexer.next()) {
    const bool isBracket = token.is(TokenKind::bracketOpen) || token.is(TokenKind::bracketClose);
    if (!isBracket && !visit(token.text)) return;
  }
}

// Keys of elements; those that are equal by chance are found out when the words are compared.
std::vector<uint64_t> keysOf(const ValueWords& value) {
  std::vector<uint64_t> keys(value.size());
  for (size_t i = 0; i < keys.size(); ++i) keys[i] = std::hash<std::string_view>()(value.bytes(i));
  return keys;
}

} // namespace

std::optional<std::string> ValueEdit::withWords() {
  size_t count = 0;
  const size_t expected = olds_.size() * olds_.wordsOfElement();
  forEachToken(text_, syntax_, [&](std::string_view) { return ++count <= expected; });
  if (count != expected) return std::nullopt;
  replaceWords({0, text_.size()}, 0, 0);
  copy(text_.size());
  return std::move(out_);
}

std::optional<std::string> ValueEdit::withElements() {
  if (!findElements()) return std::nullopt;
  if (elements_.empty() && news_.size() > 0 && !fill()) return std::nullopt;
  size_t waiting = 0, waitsBefore = 0; // new elements to insert before the old one
  const auto insertWaiting = [&](size_t now) {
    if (waiting > 0) insert(waitsBefore, now - waiting, now);
    waiting = 0;
  };
  if (!elements_.empty()) {
    const std::vector<uint64_t> olds = keysOf(olds_), news = keysOf(news_);
    forEachStep(fewestChanges(olds, news), olds.size(),
                [&](AlignmentStep step, size_t old, size_t now) {
                  if (step == AlignmentStep::insert) {
                    waitsBefore = old;
                    ++waiting;
                    return;
                  }
                  insertWaiting(now);
                  if (step == AlignmentStep::remove)
                    remove(old);
                  else if (olds_.bytes(old) != news_.bytes(now))
                    replaceWords(elements_[old], old, now);
                });
    insertWaiting(news.size());
  }
  copy(text_.size());
  return std::move(out_);
}

// Finds where the elements stand. Returns false if the text has others than the old value.
bool ValueEdit::findElements() {
  const size_t each = olds_.wordsOfElement();
  elements_.reserve(olds_.size());
  size_t words = 0;
  forEachToken(text_, syntax_, [&](std::string_view token) {
    const size_t begin = size_t(token.data() - text_.data());
    if (words % each == 0) elements_.push_back({begin, begin});
    elements_.back().end = begin + token.size();
    return ++words <= olds_.size() * each;
  });
  return words == olds_.size() * each;
}

// Appends a part of the new text. Words that would become one are kept apart.
void ValueEdit::append(std::string_view text) {
  if (text.empty()) return;
  if (!out_.empty() && !isVrmlSeparator(out_.back()) && !isVrmlSeparator(text[0])) out_ += ' ';
  out_ += text;
}

void ValueEdit::copy(size_t end) {
  if (end <= at_) return;
  append(text_.substr(at_, end - at_));
  at_ = end;
}

// Replaces the words that differ in a part of the text, which has whole elements from `old` on.
void ValueEdit::replaceWords(const TextSpan& part, size_t old, size_t now) {
  const size_t each = olds_.wordsOfElement();
  size_t word = 0; // within its element
  bool differs = false;
  std::vector<std::string> before, after;
  const auto visit = [&](std::string_view token) {
    if (word == 0) differs = olds_.bytes(old) != news_.bytes(now);
    if (word == 0 && differs) {
      before = olds_.words(old, syntax_);
      after = news_.words(now, syntax_);
      // The old axis may have another length in the text, so a changed one is written as a whole.
      if (olds_.hasAxes() && !std::equal(after.begin(), after.begin() + 3, before.begin()))
        std::fill_n(before.begin(), 3, std::string());
    }
    if (differs && before[word] != after[word]) {
      copy(size_t(token.data() - text_.data()));
      append(news_.spelledLike(token, after[word]));
      at_ = size_t(token.data() - text_.data()) + token.size();
    }
    if (++word == each) {
      word = 0;
      ++old;
      ++now;
    }
    return true;
  };
  forEachToken(text_.substr(part.begin, part.size()), syntax_, visit);
}

// Removes blanks from the end of what has been written, and a comma.
void ValueEdit::stripLine(bool withComma) {
  const auto strip = [this] {
    while (!out_.empty() && isBlank(out_.back())) out_.pop_back();
  };
  strip();
  if (!withComma || out_.empty() || out_.back() != ',') return;
  out_.pop_back();
  strip();
}

// Leaves out an element with the comma behind it, and the line if nothing else stands in it.
void ValueEdit::remove(size_t old) {
  const TextSpan& element = elements_[old];
  copy(element.begin);
  at_ = element.end;
  bool hadComma = false;
  for (; at_ < text_.size() && (isBlank(text_[at_]) || text_[at_] == ','); ++at_)
    hadComma |= text_[at_] == ',';
  const bool isLineBlank = xvrml::startsLine(out_, out_.size());
  if (at_ == text_.size()) { // the last one of XML
    while (!out_.empty() && isVrmlSpace(out_.back())) out_.pop_back();
  } else if (out_.empty()) { // the first one of XML
    while (at_ < text_.size() && isVrmlSpace(text_[at_])) ++at_;
  } else if (isLineEnd(text_[at_])) {
    stripLine(!hadComma && !isLineBlank);
    if (isLineBlank) at_ = nextLine(text_, at_);
  } else if (text_[at_] == ']' && !isLineBlank) {
    stripLine(!hadComma);
    if (at_ > element.end) out_ += ' ';
  }
}

// Inserts new elements before an old one, or behind the last one.
void ValueEdit::insert(size_t old, size_t first, size_t last) {
  if (old == 0)
    insertBefore(first, last);
  else
    insertBehind(old - 1, first, last);
}

void ValueEdit::insertBefore(size_t first, size_t last) {
  copy(elements_[0].begin);
  const bool inLines = startsLine(0) && standsAlone(0);
  const std::string between =
      inLines ? fmt::format("{}{}{}", usesCommas(0) ? "," : "", lines_.feed, *indentationOf(0))
              : std::string(separatorBeside(0));
  const std::string_view within = separatorWithin(0);
  for (size_t now = first; now < last; ++now) {
    appendElement(now, within);
    out_ += between;
  }
}

// Inserts elements in lines of their own if the old one has a line of its own.
void ValueEdit::insertBehind(size_t old, size_t first, size_t last) {
  const size_t end = elements_[old].end;
  const bool commas = usesCommas(old), hadComma = hasComma(old);
  const std::optional<std::string_view> indentation = indentationOf(old);
  copy(end);
  if (!indentation || !standsAlone(old))
    return appendInLine({first, last}, separatorBeside(old), separatorWithin(old), false);
  if (commas && !hadComma) out_ += ',';
  copy(lineEnd(text_, end));
  const std::string_view within = separatorWithin(old);
  for (size_t now = first; now < last; ++now) {
    out_.append(lines_.feed).append(*indentation);
    appendElement(now, within);
    if (commas && (hadComma || now + 1 < last)) out_ += ',';
  }
}

// Writes the elements of a list that has had none, if its closing bracket has a line of its own:
// there may be comments in the list.
bool ValueEdit::fill() {
  const size_t close = text_.empty() ? 0 : text_.size() - 1;
  if (close == 0 || text_[close] != ']') return false;
  size_t begin = close; // after it a comma at most
  while (begin > 0 && (isBlank(text_[begin - 1]) || text_[begin - 1] == ',')) --begin;
  if (begin == 0 || !isLineEnd(text_[begin - 1])) return false;
  copy(begin);
  at_ = close; // without commas
  out_.append(indentationAt(text_, close)).append("  ");
  const bool commas = news_.wordsOfElement() > 1 || syntax_.isJson;
  appendInLine({0, news_.size()}, commas ? ", " : " ", syntax_.isJson ? ", " : " ", true);
  out_.append(lines_.feed).append(indentationAt(text_, close));
  return true;
}

void ValueEdit::appendElement(size_t now, std::string_view within) {
  bool isFirst = true;
  for (const std::string& word : news_.words(now, syntax_)) {
    if (!isFirst) out_ += within;
    append(word);
    isFirst = false;
  }
}

// Writes elements one behind the other, in lines that are not too long. The first one may need a
// separator, too. Strings of XML stay in one line, whose end would have to be escaped.
void ValueEdit::appendInLine(const TextSpan& elements, std::string_view separator,
                             std::string_view within, bool isFirst) {
  const bool mayBreak = !syntax_.isXml() || !news_.hasStrings();
  size_t line = out_.size(); // where the line begins, or what is added to it
  for (size_t now = elements.begin; now < elements.end; ++now) {
    if (now > elements.begin || !isFirst) out_ += separator;
    if (mayBreak && out_.size() - line > lineWidth) {
      const bool isOwnLine = lineBegin(out_, out_.size()) > 0;
      const std::string inner = isOwnLine ? std::string(indentationAt(out_, out_.size()))
                                          : std::string(lines_.indent + 2, ' ');
      stripLine(false);
      out_.append(lines_.feed).append(inner);
      line = out_.size();
    }
    appendElement(now, within);
  }
}

// Returns where the next element begins, or the text ends.
size_t ValueEdit::endOfGap(size_t old) const {
  return old + 1 < elements_.size() ? elements_[old + 1].begin : text_.size();
}

// Returns whether an element begins a line of the value; the line before the value is not known.
bool ValueEdit::startsLine(size_t old) const {
  size_t begin = elements_[old].begin;
  while (begin > 0 && isBlank(text_[begin - 1])) --begin;
  return begin > 0 && isLineEnd(text_[begin - 1]);
}

// Returns whether no other element, and no bracket behind it, stands in the line of an element.
bool ValueEdit::standsAlone(size_t old) const {
  const auto hasEnd = [this](size_t begin, size_t end) {
    return lineEnd(text_.substr(0, end), begin) < end;
  };
  if (old > 0 && !hasEnd(elements_[old - 1].end, elements_[old].begin)) return false;
  const bool isLast = old + 1 == elements_.size();
  return isLast ? endsLine(text_, elements_[old].end)
                : hasEnd(elements_[old].end, elements_[old + 1].begin);
}

// Returns whether a comma stands behind an element.
bool ValueEdit::hasComma(size_t old) const {
  const size_t end = endOfGap(old);
  for (size_t at = elements_[old].end; at < end; ++at) {
    if (text_[at] == ',') return true;
    if (text_[at] == '#') at = lineEnd(text_, at);
  }
  return false;
}

// Returns whether elements beside an old one are separated by commas.
bool ValueEdit::usesCommas(size_t old) const {
  if (syntax_.isJson || hasComma(old)) return true;
  if (old + 1 < elements_.size()) return false;
  return old > 0 ? hasComma(old - 1) : olds_.wordsOfElement() > 1;
}

// Returns a part of the text if it separates words and does not end a line; else the other one.
std::string_view ValueEdit::separatorOr(size_t begin, size_t end, std::string_view other) const {
  const std::string_view gap = text_.substr(begin, end - begin);
  return gap.empty() || gap.find_first_not_of(" \t,") != gap.npos ? other : gap;
}

// Returns what stands between elements beside an old one, or between the words of one.
std::string_view ValueEdit::separatorBeside(size_t old) const {
  std::string_view usual = usesCommas(old) ? ", " : " ";
  if (old > 0) usual = separatorOr(elements_[old - 1].end, elements_[old].begin, usual);
  if (old + 1 == elements_.size()) return usual;
  return separatorOr(elements_[old].end, elements_[old + 1].begin, usual);
}
std::string_view ValueEdit::separatorWithin(size_t old) const {
  const TextSpan& element = elements_[old];
  std::vector<size_t> ends; // where the first word ends, and the second one begins
  forEachToken(text_.substr(element.begin, element.size()), syntax_, [&](std::string_view token) {
    const size_t begin = size_t(token.data() - text_.data());
    ends.push_back(ends.empty() ? begin + token.size() : begin);
    return ends.size() < 2;
  });
  const std::string_view usual = syntax_.isJson ? ", " : " ";
  return ends.size() < 2 ? usual : separatorOr(ends[0], ends[1], usual);
}

// Returns the indentation of the line that an element begins, or that the next one begins.
std::optional<std::string_view> ValueEdit::indentationOf(size_t old) const {
  if (startsLine(old)) return indentationAt(text_, elements_[old].begin);
  if (old + 1 < elements_.size() && startsLine(old + 1))
    return indentationAt(text_, elements_[old + 1].begin);
  return std::nullopt;
}

} // namespace xvrml
