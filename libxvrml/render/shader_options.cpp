// shader_options.cpp: the parameters that an ORTShader sets, in its options ("3f reflectance .9 .9
// .9", one or several in a string) or in fields that it declares.
//   options := { option };  option := type name value*;  the type determines the number of values.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "xvrml/appearance.h"
#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

class Words {
 public:
  explicit Words(std::string_view text) : rest_(text), bytes_(text.size()) {}
  std::optional<std::string_view> peek() const { return Words(*this).next(); }
  std::optional<std::string_view> next() {
    cut_ = false;
    const size_t start = rest_.find_first_not_of(" \t\r\n,");
    if (start == std::string_view::npos) return std::nullopt;
    rest_.remove_prefix(start);
    const bool quoted = rest_.front() == '\'';
    const size_t end = quoted ? rest_.find('\'', 1) : rest_.find_first_of(" \t\r\n,");
    const std::string_view word = rest_.substr(quoted ? 1 : 0, end == std::string_view::npos ? end
                                                               : quoted ? end - 1
                                                                        : end);
    cut_ = !quoted && end < rest_.size() && rest_[end] == ',' &&
           rest_.find_first_of(" \t\r\n,", end + 1) != end + 1 && end + 1 < rest_.size();
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : quoted ? end + 1 : end);
    return word;
  }
  // Returns whether a comma without a blank ended the last word, so that it may be part of one.
  bool cut() const { return cut_; }
  // Returns how many bytes have been read.
  size_t place() const { return bytes_ - rest_.size(); }

 private:
  std::string_view rest_;
  size_t bytes_;
  bool cut_ = false;
};

template <class T> bool number(std::string_view word, T& out) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc() && end == word.data() + word.size();
}

int floatsOf(std::string_view type) {
  if (type == "1f" || type == "2f" || type == "3f" || type == "4f") return type[0] - '0';
  return type == "16f" ? 16 : type == "color" ? 3 : 0;
}

// Reads the values of one option. Returns the error, or "".
std::string readValues(Words& words, std::string_view type, ShaderOption& option) {
  const auto missing = [&] {
    return "option " + option.name + ": too few values for " + std::string(type);
  };
  if (const int count = floatsOf(type)) {
    option.type = type == "color" ? ShaderOption::Type::color : ShaderOption::Type::floats;
    for (int i = 0; i < count; ++i) {
      const auto word = words.next();
      float value = 0;
      if (!word) return missing();
      if (!number(*word, value) || !std::isfinite(value))
        return "option " + option.name + ": '" + std::string(*word) + "' is not a number";
      option.numbers.push_back(value);
    }
    return {};
  }
  if (type == "floats") {
    option.type = ShaderOption::Type::list;
    float value = 0;
    for (auto word = words.peek(); word && number(*word, value) && std::isfinite(value);
         word = words.peek()) {
      option.numbers.push_back(value);
      words.next();
    }
    return {};
  }
  const auto word = words.next();
  if (!word) return missing();
  if (type == "1i") {
    option.type = ShaderOption::Type::integer;
    return number(*word, option.integer)
               ? ""
               : "option " + option.name + ": '" + std::string(*word) + "' is not an integer";
  }
  if (type == "bool") {
    option.type = ShaderOption::Type::boolean;
    option.integer = *word == "true" || *word == "TRUE" || *word == "1";
    const bool known = option.integer || *word == "false" || *word == "FALSE" || *word == "0";
    return known ? ""
                 : "option " + option.name + ": '" + std::string(*word) +
                       "' is neither true nor false";
  }
  option.type = type == "string" ? ShaderOption::Type::text
                : type == "file" ? ShaderOption::Type::file
                                 : ShaderOption::Type::texture;
  option.text = *word;
  return {};
}

bool isText(const ShaderOption& option) {
  return option.type == ShaderOption::Type::text || option.type == ShaderOption::Type::texture ||
         option.type == ShaderOption::Type::file;
}

bool knownType(std::string_view type) {
  return floatsOf(type) > 0 || type == "1i" || type == "bool" || type == "string" ||
         type == "texture" || type == "file" || type == "floats";
}

} // namespace

std::vector<ShaderOption> parseShaderOptions(const MFString& options,
                                             std::vector<std::string>& errors) {
  std::vector<ShaderOption> result;
  for (size_t element = 0; element < options.size(); ++element) {
    Words words(options[element]);
    bool cut = false; // the last option of this string is a text that a comma ended
    while (const auto type = words.next()) {
      if (cut && !knownType(*type)) {
        // Part of a text, such as the second half of a,b.png.
        errors.push_back("option " + result.back().name + ": a comma ends '" + result.back().text +
                         "'; write a value that has a comma in single quotes");
        result.pop_back();
        break;
      }
      const auto name = words.next();
      if (!knownType(*type) || !name) {
        errors.push_back(
            name ? "option type '" + std::string(*type) +
                       "': expected 1i 1f 2f 3f 4f 16f bool color string texture file or floats"
                 : "option '" + std::string(*type) + "' has no name");
        break; // the rest of this string cannot be parsed
      }
      if (result.size() == maximumShaderOptions) {
        errors.push_back("more than " + std::to_string(maximumShaderOptions) +
                         " options; the rest is left out");
        return result;
      }
      ShaderOption option;
      option.name = *name;
      option.element = element;
      option.begin = words.place();
      if (std::string error = readValues(words, *type, option); !error.empty()) {
        errors.push_back(std::move(error));
        break;
      }
      option.end = words.place();
      result.push_back(std::move(option));
      cut = isText(result.back()) && words.cut();
    }
  }
  return result;
}

namespace {

// Reads a value into an option. Returns false if the value sets nothing.
struct Reader {
  ShaderOption& option;
  using Type = ShaderOption::Type;

  bool operator()(bool value) const {
    option.type = Type::boolean;
    option.integer = value;
    return true;
  }
  bool operator()(int32_t value) const {
    option.type = Type::integer;
    option.integer = value;
    return true;
  }
  bool operator()(const std::string& value) const {
    option.type = Type::text;
    option.text = value;
    return true;
  }
  bool operator()(const MFString& urls) const {
    if (urls.empty()) return false;
    option.type = Type::file;
    option.text = urls[0];
    option.otherUrls.assign(urls.begin() + 1, urls.end());
    return true;
  }
  bool operator()(const NodeRef& node) const {
    option.type = Type::node;
    option.picture = node;
    return bool(node);
  }
  template <class T> bool operator()(const T& value) const {
    if constexpr (isNumberList<T>) {
      option.type = Type::list;
      for (const auto& one : value) append(one);
    } else if constexpr (Numeric<T>) {
      option.type = Type::floats;
      append(value);
    }
    return isNumberList<T> || Numeric<T>;
  }
  template <class T> void append(const T& value) const {
    for (int i = 0; i < numberCount<T>; ++i) option.numbers.push_back(float(numbersOf(value)[i]));
  }
};

} // namespace

std::optional<ShaderOption> declaredOption(const nodes::ORTShader& shader, const FieldInfo& field) {
  ShaderOption option;
  option.name = field.name;
  option.field = &field;
  const bool sets = visitStorage(field.type, shader.storage(field),
                                 [&](const auto& value) { return Reader{option}(value); });
  return sets ? std::optional(std::move(option)) : std::nullopt;
}

std::vector<ShaderOption> shaderOptions(const nodes::ORTShader& shader) {
  std::vector<std::string> errors;
  std::vector<ShaderOption> options = parseShaderOptions(shader.options, errors);
  for (const FieldInfo& field : shader.type().fields) {
    if (!field.declared || !holdsValue(field)) continue;
    std::erase_if(options, [&](const ShaderOption& one) { return one.name == field.name; });
    if (std::optional<ShaderOption> option = declaredOption(shader, field))
      options.push_back(std::move(*option));
  }
  return options;
}

} // namespace xvrml
