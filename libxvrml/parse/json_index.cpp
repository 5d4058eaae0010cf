// json_index.cpp: makes the index from the events of nlohmann's parser, which is not recursive.
#include "parse/json_index.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "parse/parser.h"

namespace xvrml {
namespace {

// Where the parser is. Numbers that are too large for a double are well-formed JSON, but the parser
// would end at them: it gets other digits, because only the places of numbers matter here.
struct Position {
  const char* at;
  const char* const end;
  bool string = false, escaped = false, exponent = false;
  int digits = 0; // digits of the number, up to `at`

  static bool isDigit(char c) { return c >= '0' && c <= '9'; }
  char character() const { return exponent && isDigit(*at) ? '0' : *at; }
  void next() {
    constexpr int mostDigits = 300;
    const char c = *at++;
    if (string) {
      string = escaped || c != '"';
      escaped = !escaped && c == '\\';
      return;
    }
    string = c == '"';
    exponent = ((c == 'e' || c == 'E') && digits > 0) ||
               (exponent && (isDigit(c) || c == '+' || c == '-'));
    digits = isDigit(c) ? digits + 1 : 0;
    while (digits >= mostDigits && at < end && isDigit(*at)) ++at;
  }
};

// An iterator whose copies share one position, so that the events know where the parser is.
class SharedPosition {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;
  explicit SharedPosition(Position& position) : position_(&position) {}
  reference operator*() const { return position_->character(); }
  SharedPosition& operator++() {
    position_->next();
    return *this;
  }
  bool operator==(const SharedPosition& other) const {
    return position_->at == other.position_->at;
  }
  bool operator!=(const SharedPosition& other) const { return !(*this == other); }

 private:
  Position* position_;
};

// A node takes at most three levels: its object, that of its type, and the list of its children.
constexpr size_t deepest = 3 * Parser::maximumNesting + 100;

} // namespace

class JsonIndex::Reader : public nlohmann::json_sax<nlohmann::json> {
 public:
  Reader(Locator& locator, JsonIndex& index)
      : locator_(locator), index_(index),
        end_(locator.text().data() + locator.text().size()), position_{locator.text().data(), end_},
        done_(position_.at) {}

  void read() {
    Position end{end_, end_};
    index_.whole_ = nlohmann::json::sax_parse(SharedPosition(position_), SharedPosition(end), this);
    while (!open_.empty()) { // after an error
      index_.values_[open_.back()].complete = false;
      leave();
    }
  }

  bool null() override { return single(Value::Kind::other, false); }
  bool boolean(bool) override { return single(Value::Kind::other, false); }
  bool number_integer(number_integer_t) override { return single(Value::Kind::other, true); }
  bool number_unsigned(number_unsigned_t) override { return single(Value::Kind::other, true); }
  bool number_float(number_float_t, const string_t&) override {
    return single(Value::Kind::other, true);
  }
  bool string(string_t&) override {
    if (inArray()) index_.values_[open_.back()].hasStrings = true;
    return single(Value::Kind::string, false);
  }
  bool binary(binary_t&) override { return false; } // JSON has none
  bool start_object(size_t) override { return enter(Value::Kind::object); }
  bool key(string_t&) override {
    const char* const first = tokenStart();
    key_ = {first + 1, static_cast<size_t>(position_.at - first - 2)};
    done_ = position_.at;
    return true;
  }
  bool end_object() override { return leave(); }
  bool start_array(size_t) override { return enter(Value::Kind::array); }
  bool end_array() override { return leave(); }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    std::string_view text = error.what();
    if (const size_t what = text.find("syntax error"); what != text.npos)
      text.remove_prefix(what);
    else if (const size_t behind = text.find("] "); behind != text.npos)
      text.remove_prefix(behind + 2);
    locator_.error(position_.at,
                   fmt::format("this is not well-formed JSON: {}; what follows is left "
                               "out",
                               text.substr(0, 160)));
    return false;
  }

 private:
  bool inArray() const {
    return !open_.empty() && index_.values_[open_.back()].kind == Value::Kind::array;
  }

  // Returns where the token that was just read begins: only separators stand before it.
  const char* tokenStart() const {
    const char* p = done_;
    while (p < end_ &&
           (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n' || *p == ',' || *p == ':'))
      ++p;
    return p;
  }

  bool add(Value::Kind kind, const char* end) {
    if (!index_.share_.take(sizeof(Value))) {
      locator_.error(position_.at,
                     fmt::format("the index of this file takes, together with the rest "
                                 "of the world, more than {}; what follows is left out",
                                 index_.share_.budget()->name()));
      return false;
    }
    const char* const first = tokenStart();
    Value value;
    value.kind = kind;
    value.key = inArray() ? std::string_view() : std::exchange(key_, {});
    value.text = {first, static_cast<size_t>(end - first)};
    index_.values_.push_back(value);
    index_.values_.back().next = index_.values_.size();
    return true;
  }

  // The parser reads one character behind a number.
  bool single(Value::Kind kind, bool number) {
    const char* const end = number && position_.at < end_ ? position_.at - 1 : position_.at;
    const bool good = (inArray() && kind == Value::Kind::other) || add(kind, end);
    done_ = end;
    return good;
  }

  bool enter(Value::Kind kind) {
    if (open_.size() >= deepest) {
      locator_.error(position_.at - 1, fmt::format("objects and lists nested deeper than {}; what "
                                                   "follows is left out",
                                                   deepest));
      return false;
    }
    if (!add(kind, position_.at)) return false;
    open_.push_back(index_.values_.size() - 1);
    done_ = position_.at;
    return true;
  }

  bool leave() {
    Value& value = index_.values_[open_.back()];
    open_.pop_back();
    value.text = {value.text.data(), static_cast<size_t>(position_.at - value.text.data())};
    value.next = index_.values_.size();
    done_ = position_.at;
    return true;
  }

  Locator& locator_;
  JsonIndex& index_;
  const char* end_;
  Position position_; // behind the last character that the parser has read
  const char* done_;  // behind the last token
  std::string_view key_;
  std::vector<size_t> open_; // the objects and arrays around the token
};

JsonIndex::JsonIndex(Locator& locator, const BudgetPtr& budget) : share_(budget) {
  Reader(locator, *this).read();
}

const JsonIndex::Value& JsonIndex::from(const char* at) const {
  return *std::lower_bound(
      values_.begin(), values_.end(), at,
      [](const Value& value, const char* place) { return value.text.data() < place; });
}

std::string JsonIndex::decoded(const Value& string) const {
  if (string.text.find('\\') == string.text.npos)
    return std::string(string.text.substr(1, string.text.size() - 2));
  return nlohmann::json::parse(string.text).get<std::string>();
}

std::vector<std::string> JsonIndex::strings(const Value& array) const {
  std::vector<std::string> result;
  eachWithin(static_cast<size_t>(&array - values_.data()), [&](size_t i) {
    if (values_[i].kind == Value::Kind::string) result.push_back(decoded(values_[i]));
  });
  return result;
}

} // namespace xvrml
