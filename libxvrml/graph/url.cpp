// url.cpp: resolves the URLs of a world. Relative URLs lead to files beside the file that holds
// them (ISO/IEC 14772-1 4.5.3), absolute ones only if allowed; nothing is fetched from the network.
// Used by the loader and the mapper. Pure except for file look-ups. [any thread]
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <unordered_map>

#include <fmt/format.h>

#include "base/percent.h"
#include "graph/url.h"
#include "lower_case.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// Decodes %XX. Returns false if there is a NUL, which no file name can contain.
bool percentDecode(std::string_view text, std::string& out) {
  out = percentDecoded(text);
  return out.find('\0') == out.npos;
}

// Returns the real path of the folder that holds the file. Two such paths can be compared.
std::filesystem::path realFolder(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(file).parent_path();
  std::error_code error;
  const fs::path absolute = fs::absolute(folder.empty() ? fs::path(".") : folder, error);
  if (error) return folder.lexically_normal();
  fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

// Encodes a path so that it can be the beginning of a relative URL.
std::string percentEncode(const std::string& path) {
  std::string url;
  for (const char c : path) {
    const bool plain = static_cast<unsigned char>(c) > ' ' &&
                       std::string_view("%#?:\\").find(c) == std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view url) {
  const size_t first = std::min(url.find_first_not_of(blanks), url.size());
  return url.substr(first, url.find_last_not_of(blanks) + 1 - first);
}

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

// The names in the folder that was searched last. Worlds name many files of one folder.
class Listing {
 public:
  // Returns the name in a folder that differs from `name` in the case of letters only: the first in
  // the order of bytes. "" if there is none. folder: "" or with a slash at its end.
  std::string find(const std::string& folder, std::string_view name) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path place = folder.empty() ? fs::path(".") : fs::path(folder);
    const auto changed = fs::last_write_time(place, error);
    if (error) return {};
    if (folder != folder_ || changed != changed_ || !isSettled_ || names_.empty()) {
      // Times of files are coarse: a folder that has just changed may change again unnoticed.
      isSettled_ = changed + std::chrono::seconds(1) < fs::file_time_type::clock::now();
      names_.clear();
      for (fs::directory_iterator one(place, error), end;
           !error && one != end && names_.size() < most; one.increment(error)) {
        const std::string its = one->path().filename().string();
        std::string& known = names_[lowerCase(its)];
        if (known.empty() || its < known) known = its;
      }
      folder_ = folder;
      changed_ = changed;
    }
    const auto found = names_.find(lowerCase(name));
    return found == names_.end() ? std::string() : found->second;
  }

 private:
  static constexpr size_t most = 100'000; // names that are looked at
  std::string folder_;
  std::filesystem::file_time_type changed_;
  bool isSettled_ = false; // the folder had not changed for a while when it was read
  std::unordered_map<std::string, std::string> names_; // by their names in lower case
};

// Returns the path of a file whose name, or whose folders' names, are written with other letters as
// to case: such worlds were made where that makes no difference. "" if there is none. `folder` is
// written as it is.
std::string findInAnyCase(std::string folder, std::string_view path) {
  thread_local Listing listing;
  for (size_t depth = 0; !path.empty() && depth < 64; ++depth) {
    const size_t slash = std::min(path.find('/'), path.size());
    const std::string part(path.substr(0, slash));
    path.remove_prefix(std::min(path.size(), slash + 1));
    std::error_code error;
    std::string name = part;
    const bool there = part.empty() || part == "." || part == ".." ||
                       std::filesystem::exists(folder + part, error);
    if (!there) name = listing.find(folder, part);
    if (!there && name.empty()) return {};
    folder += name;
    if (!path.empty()) folder += '/';
  }
  return exists(folder) ? folder : std::string();
}

} // namespace

std::string urlScheme(std::string_view url) {
  const size_t colon = url.find(':');
  if (colon == url.npos || colon == 0 || url.find_first_of("/\\?#") < colon) return {};
  std::string name(url.substr(0, colon));
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.'))
      return {};
  }
  return name;
}

std::string relativeUrl(const std::string& file, const std::string& from) {
  MFString urls{percentEncode(std::filesystem::path(file).filename().string())};
  rebaseUrls(urls, file, from);
  return urls.front();
}

void rebaseUrls(MFString& urls, const std::string& from, const std::string& to) {
  if (from.substr(0, from.rfind('/') + 1) == to.substr(0, to.rfind('/') + 1)) return;
  std::string step; // from one folder to the other; made when the first URL needs it
  for (std::string& url : urls) {
    const std::string_view bare = trimmed(url);
    if (bare.empty() || std::string_view("/\\#").find(bare[0]) != std::string_view::npos ||
        !urlScheme(bare).empty())
      continue;
    if (step.empty()) step = percentEncode(realFolder(from).lexically_relative(realFolder(to)));
    if (step.empty() || step == ".") return;
    url = step + '/' + std::string(bare);
  }
}

ResolvedUrl resolveUrl(std::string_view url, std::string_view baseFile,
                       const LoadOptions& options) {
  const auto refuse = [&](std::string_view why) {
    return ResolvedUrl{{}, {}, fmt::format("'{}': {}", url.substr(0, 100), why)};
  };
  url = trimmed(url);
  if (url.empty()) return refuse("the URL is empty");

  std::string kind = urlScheme(url);
  bool absolute = false;
  std::string_view path = url;
  if (kind == "file") {
    absolute = true;
    path.remove_prefix(5);
    if (path.starts_with("//")) path.remove_prefix(2);
    if (path.starts_with("localhost/")) path.remove_prefix(9);
    if (!options.allowAbsolute)
      return refuse("file: URLs are not followed unless absolute paths are allowed");
  } else if (kind.size() == 1) {
    return refuse("paths with a drive letter are not followed");
  } else if (kind == "urn") {
    return refuse("a urn: names no file");
  } else if (!kind.empty()) {
    return refuse(fmt::format("{}: URLs are not fetched", kind));
  } else if (path.starts_with("//") || path.starts_with("\\\\")) {
    return refuse("nothing is fetched from a network");
  }

  ResolvedUrl result;
  const std::string_view whole = path;
  const size_t hash = path.find('#');
  if (hash != path.npos) {
    if (!percentDecode(path.substr(hash + 1), result.fragment)) return refuse("%00 in a name");
    path = path.substr(0, hash);
  }
  std::string decoded;
  if (!percentDecode(path, decoded) || path.find('\0') != path.npos) return refuse("%00 in a path");
  std::string literal(path);
  std::replace(decoded.begin(), decoded.end(), '\\', '/'); // a path written on Windows
  if (decoded.starts_with('/')) absolute = true;
  if (absolute && !options.allowAbsolute)
    return refuse("absolute paths are not followed unless allowed");
  if (decoded.empty()) { // "#name" refers to the file itself
    if (baseFile == "-") return refuse("standard input cannot be read twice");
    result.path = baseFile;
    return result;
  }
  const size_t slash = baseFile.rfind('/');
  const std::string folder =
      absolute || slash == baseFile.npos ? "" : std::string(baseFile.substr(0, slash + 1));
  result.path = folder + decoded;
  if (result.path == "-") result.path = "./-"; // a file of that name, not standard input
  if (exists(result.path)) return result;
  // The file name itself may contain %20 or a backslash, or the URL may have a query.
  std::string before, folderOfUrl;
  percentDecode(path.substr(0, path.find('?')), before);
  std::replace(before.begin(), before.end(), '\\', '/');
  const size_t name = path.rfind('/') + 1; // 0 if there is no '/'
  percentDecode(path.substr(0, name), folderOfUrl);
  for (const std::string& other : {literal, folderOfUrl + literal.substr(name), before}) {
    if (!exists(folder + other)) continue;
    result.path = folder + other;
    return result;
  }
  // The name itself may contain a '#'; other than in a URL, it then begins no fragment.
  std::string unsplit;
  if (hash != whole.npos && percentDecode(whole, unsplit) && exists(folder + unsplit)) {
    result.fragment.clear();
    result.path = folder + unsplit;
    return result;
  }
  if (absolute) return result;
  if (std::string found = findInAnyCase(folder, decoded); !found.empty()) {
    result.path = std::move(found);
  } else if (found = findInAnyCase(folder, unsplit); !found.empty()) {
    result.fragment.clear();
    result.path = std::move(found);
  }
  return result;
}

} // namespace xvrml
