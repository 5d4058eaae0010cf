// json.h: the JSON of a glTF file, read within limits, and typed access to its members. Whatever a
// member should be is checked where it is read; a wrong one gets one message with its path
// ("meshes/3/primitives/0/indices") and is treated as missing. [the thread that loads]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "parse/mesh/mesh_file.h"

namespace xvrml::gltf {

using Json = nlohmann::json;

// A value of the document, or none. Cheap to copy but for its path.
class Item {
 public:
  Item(Locator& locator, const Json* json, std::string path)
      : locator_(&locator), json_(json), path_(std::move(path)) {}

  explicit operator bool() const { return json_ != nullptr; }
  const std::string& path() const { return path_; }
  bool has(std::string_view key) const { return find(key) != nullptr; }

  // Members. A missing one gives the fallback, or an item that is none.
  Item object(std::string_view key) const;
  double number(std::string_view key, double fallback) const; // finite
  bool boolean(std::string_view key, bool fallback) const;
  std::string text(std::string_view key) const;            // "" if it is missing
  const std::string* longText(std::string_view key) const; // the same without a copy, or null
  // A count or an offset of bytes.
  uint64_t count(std::string_view key, uint64_t fallback) const;
  // An index of a list with `size` elements; none if it is missing or out of range.
  std::optional<size_t> index(std::string_view key, size_t size) const;
  std::vector<size_t> indices(std::string_view key, size_t size) const;
  // Exactly so many finite numbers; empty if it is missing.
  std::vector<double> numbers(std::string_view key, size_t size) const;
  // A list of any number of finite numbers.
  std::vector<double> numbers(std::string_view key) const;
  // The objects of a list; other elements are reported and become items that are none.
  std::vector<Item> list(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  // The object of an extension.
  Item extension(std::string_view name) const;
  // The names of the members, sorted.
  std::vector<std::string> keys() const;

  void error(std::string_view message) const;
  void warn(std::string_view message) const;

 private:
  const Json* find(std::string_view key) const;
  const Json* findArray(std::string_view key) const;
  void wrong(std::string_view key, std::string_view expected) const;

  Locator* locator_;
  const Json* json_;
  std::string path_;
};

// Parses the text of a document, whose memory is taken from `scratch`. Throws MeshFault.
Json parseJson(std::string_view text, const Limits& limits, Scratch& scratch);

} // namespace xvrml::gltf
