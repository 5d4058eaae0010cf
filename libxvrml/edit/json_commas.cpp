#include "edit/json_commas.h"

#include <algorithm>
#include <vector>

namespace xvrml {
namespace {

class Commas {
 public:
  explicit Commas(std::string_view text) : text_(text) { out_.reserve(text.size() + 64); }

  std::string mended() {
    while (at_ < text_.size()) {
      switch (text_[at_]) {
      case ' ':
      case '\t':
      case '\r':
      case '\n': out_ += text_[at_++]; break;
      case ',': comma(); break;
      case ':':
        out_ += text_[at_++];
        behindColon_ = true;
        break;
      case '{':
      case '[':
        begin();
        out_ += text_[at_++];
        open_.push_back(Before::nothing);
        break;
      case '}':
      case ']':
        if (!open_.empty() && open_.back() == Before::comma) out_.erase(comma_, 1);
        out_ += text_[at_++];
        if (!open_.empty()) open_.pop_back();
        end();
        break;
      default: word();
      }
    }
    return std::move(out_);
  }

 private:
  enum class Before : uint8_t { nothing, element, comma };

  // A second comma, and one without an element before it, is left out.
  void comma() {
    if (!open_.empty() && open_.back() == Before::element) {
      open_.back() = Before::comma;
      comma_ = out_.size();
      out_ += ',';
    }
    ++at_;
  }
  // Copies a string, number or word.
  void word() {
    begin();
    size_t to = at_ + 1;
    if (text_[at_] == '"') {
      while (to < text_.size() && text_[to] != '"') to += text_[to] == '\\' ? 2 : 1;
      to = std::min(to + 1, text_.size());
    } else {
      to = std::min(text_.find_first_of(" \t\r\n,:{}[]\"", to), text_.size());
    }
    out_.append(text_, at_, to - at_);
    at_ = to;
    end();
  }
  void begin() {
    if (!behindColon_ && !open_.empty() && open_.back() == Before::element) out_.insert(end_, ",");
    behindColon_ = false;
  }
  void end() {
    if (!open_.empty()) open_.back() = Before::element;
    end_ = out_.size();
  }

  const std::string_view text_;
  size_t at_ = 0;
  std::string out_;
  std::vector<Before> open_; // for each open object and list: what stands last in it
  size_t end_ = 0;           // behind the last element in out_
  size_t comma_ = 0;         // the last comma in out_
  bool behindColon_ = false;
};

} // namespace

std::string withCommas(std::string_view text) { return Commas(text).mended(); }

} // namespace xvrml
