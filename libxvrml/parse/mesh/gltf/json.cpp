// json.cpp: nlohmann's parser with limits for depth and memory, and checked access.
#include "parse/mesh/gltf/json.h"

#include <cmath>

#include <fmt/format.h>

namespace xvrml::gltf {
namespace {

// A value with its place in a list or an object, on a 64-bit machine with glibc's allocator.
constexpr uint64_t bytesOfValue = 100;

// "[json.exception.parse_error.101] parse error at line 1, column 3: syntax error while parsing..."
std::string reasonOf(std::string_view text) {
  const size_t at = text.find("column ");
  const size_t colon = at == text.npos ? at : text.find(": ", at);
  return shortened(colon == text.npos ? text : text.substr(colon + 2));
}

std::string describeJson(const Json& value) {
  if (value.is_string()) return fmt::format("'{}'", shortened(value.get_ref<const std::string&>()));
  if (value.is_number() || value.is_boolean()) return value.dump();
  return value.type_name();
}

bool isWhole(const Json& value, uint64_t& out) {
  if (value.is_number_unsigned()) {
    out = value.get<uint64_t>();
    return true;
  }
  if (!value.is_number_float()) return false;
  const double number = value.get<double>(); // 3.0 is written by some programs
  if (!(number >= 0 && number < 1e15) || std::trunc(number) != number) return false;
  out = uint64_t(number);
  return true;
}

// Builds the document from the events of nlohmann's parser. Its own builder with a callback
// searches the whole list behind each object, so that long lists would take quadratic time.
class Document : public nlohmann::json_sax<Json> {
 public:
  Document(std::string_view text, const Limits& limits, Scratch& scratch)
      : text_(text), limits_(limits), scratch_(scratch) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override {
    scratch_.take(2 * value.size());
    return add(std::move(value));
  }
  bool binary(binary_t&) override { return false; } // JSON has none
  bool start_object(size_t) override { return open(Json::object()); }
  bool start_array(size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    scratch_.take(bytesOfValue + 2 * value.size());
    key_ = std::move(value);
    return true;
  }
  bool parse_error(size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const size_t byte = std::min(position ? position - 1 : 0, text_.size());
    throw MeshFault{text_.data() + byte,
                    fmt::format("this is not valid JSON: {}", reasonOf(error.what()))};
  }

 private:
  bool add(Json value) {
    scratch_.take(bytesOfValue);
    if (open_.empty())
      root_ = std::move(value);
    else if (open_.back()->is_array())
      open_.back()->push_back(std::move(value));
    else
      (*open_.back())[key_] = std::move(value);
    return true;
  }

  bool open(Json value) {
    if (open_.size() >= limits_.nesting)
      throw MeshFault{nullptr,
                      fmt::format("JSON nested deeper than limit nesting={}", limits_.nesting)};
    add(std::move(value));
    if (open_.empty())
      open_.push_back(&root_);
    else if (open_.back()->is_array())
      open_.push_back(&open_.back()->back());
    else
      open_.push_back(&(*open_.back())[key_]);
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string_view text_;
  const Limits& limits_;
  Scratch& scratch_;
  Json root_;
  std::vector<Json*> open_; // the objects and lists around the next value
  std::string key_;         // the key of the next value in an object
};

} // namespace

Json parseJson(std::string_view text, const Limits& limits, Scratch& scratch) {
  Document document(text, limits, scratch);
  Json::sax_parse(text.begin(), text.end(), &document);
  return document.take();
}

void Item::error(std::string_view message) const {
  locator_->error(nullptr, fmt::format("{}: {}", path_.empty() ? "glTF" : path_, message));
}

void Item::warn(std::string_view message) const {
  locator_->warn(nullptr, fmt::format("{}: {}", path_.empty() ? "glTF" : path_, message));
}

void Item::wrong(std::string_view key, std::string_view expected) const {
  error(fmt::format("{} should be {}, found {}; it is left out", key, expected,
                    describeJson(*find(key))));
}

const Json* Item::find(std::string_view key) const {
  if (!json_ || !json_->is_object()) return nullptr;
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

const Json* Item::findArray(std::string_view key) const {
  const Json* value = find(key);
  if (value && !value->is_array()) {
    wrong(key, "a list");
    return nullptr;
  }
  return value;
}

Item Item::object(std::string_view key) const {
  const Json* value = find(key);
  if (value && !value->is_object()) {
    wrong(key, "an object");
    value = nullptr;
  }
  return {*locator_, value, path_.empty() ? std::string(key) : fmt::format("{}/{}", path_, key)};
}

double Item::number(std::string_view key, double fallback) const {
  const Json* value = find(key);
  if (!value) return fallback;
  if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
  wrong(key, "a number");
  return fallback;
}

bool Item::boolean(std::string_view key, bool fallback) const {
  const Json* value = find(key);
  if (!value) return fallback;
  if (value->is_boolean()) return value->get<bool>();
  wrong(key, "true or false");
  return fallback;
}

const std::string* Item::longText(std::string_view key) const {
  const Json* value = find(key);
  if (!value) return nullptr;
  if (value->is_string()) return &value->get_ref<const std::string&>();
  wrong(key, "a string");
  return nullptr;
}

std::string Item::text(std::string_view key) const {
  const std::string* text = longText(key);
  return text ? *text : std::string();
}

uint64_t Item::count(std::string_view key, uint64_t fallback) const {
  const Json* value = find(key);
  uint64_t number = fallback;
  if (value && !isWhole(*value, number)) wrong(key, "a whole number");
  return number;
}

std::optional<size_t> Item::index(std::string_view key, size_t size) const {
  const Json* value = find(key);
  if (!value) return {};
  uint64_t number = 0;
  if (isWhole(*value, number) && number < size) return size_t(number);
  wrong(key, size == 0 ? std::string("missing, because there is nothing that it could name")
                       : fmt::format("a number from 0 to {}", size - 1));
  return {};
}

std::vector<size_t> Item::indices(std::string_view key, size_t size) const {
  std::vector<size_t> all;
  const Json* array = findArray(key);
  if (!array) return all;
  for (const Json& value : *array) {
    uint64_t number = 0;
    if (isWhole(value, number) && number < size)
      all.push_back(size_t(number));
    else
      error(fmt::format("{} holds {}, which names nothing: there are {}; it is left out", key,
                        describeJson(value), size));
  }
  return all;
}

std::vector<double> Item::numbers(std::string_view key, size_t size) const {
  std::vector<double> all = numbers(key);
  if (all.empty() || all.size() == size) return all;
  wrong(key, fmt::format("{} numbers", size));
  return {};
}

std::vector<double> Item::numbers(std::string_view key) const {
  std::vector<double> all;
  const Json* array = findArray(key);
  if (!array) return all;
  for (const Json& value : *array) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      wrong(key, "a list of numbers");
      return {};
    }
    all.push_back(value.get<double>());
  }
  return all;
}

std::vector<Item> Item::list(std::string_view key) const {
  std::vector<Item> all;
  const Json* array = findArray(key);
  if (!array) return all;
  for (size_t i = 0; i < array->size(); ++i) {
    const Json& value = (*array)[i];
    std::string path = fmt::format("{}{}{}/{}", path_, path_.empty() ? "" : "/", key, i);
    all.emplace_back(*locator_, value.is_object() ? &value : nullptr, std::move(path));
    if (!value.is_object()) all.back().error("expected an object");
  }
  return all;
}

std::vector<std::string> Item::texts(std::string_view key) const {
  std::vector<std::string> all;
  const Json* array = findArray(key);
  if (!array) return all;
  for (const Json& value : *array)
    if (value.is_string()) all.push_back(value.get<std::string>());
  return all;
}

Item Item::extension(std::string_view name) const { return object("extensions").object(name); }

std::vector<std::string> Item::keys() const {
  std::vector<std::string> names;
  if (json_ && json_->is_object())
    for (const auto& member : json_->items()) names.push_back(member.key());
  return names;
}

} // namespace xvrml::gltf
