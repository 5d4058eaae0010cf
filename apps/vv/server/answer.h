// answer.h: Makes what an HTTP request gets: a file of the page, a saved picture, or a refusal.
// Knows nothing about connections. [the host's thread, except Downloads::offer]
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/access.h"

namespace vv::server {

// The files in apps/vv/server/page, which CMake puts into the program.
struct PageFile {
  std::string_view name, content;
};
std::span<const PageFile> pageFiles();

// Pictures that wait to be fetched. Each has a path that cannot be guessed. [any thread]
class Downloads {
 public:
  struct File {
    std::string path, name, type;
    std::shared_ptr<const std::string> content;
    double offered = 0; // time in seconds of any clock
  };
  // Returns the path of the file, without a slash at its beginning.
  std::string offer(std::string name, std::string type, std::string content, double seconds);
  // Returns the file; its content is null if there is none, or not any more.
  File find(std::string_view path, double seconds);

 private:
  void drop(double seconds);

  std::mutex mutex_;
  std::deque<File> files_; // the oldest first
};

// Pictures in PNG that the editor's pages show. Each has a path that cannot be guessed. [any
// thread]
class Images {
 public:
  // Keeps a picture until it is removed. Returns its path, without a slash at its beginning.
  std::string add(std::string png);
  void remove(const std::string& path);
  // Returns null if there is none, or not any more.
  std::shared_ptr<const std::string> find(std::string_view path);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const std::string>, std::less<>> files_; // by path
};

struct Answer {
  int status = 200;
  std::string type;
  std::vector<std::pair<std::string, std::string>> headers; // names in lower case
  std::shared_ptr<const std::string> body;
  bool mayBeKept = false; // the browser need not ask again: the path always means the same
};

struct Request {
  std::string_view method, path; // path: as it came, "/" at the beginning
  Verdict verdict = Verdict::tokenMissing;
  std::string_view token;      // the one that the visitor has shown; empty: none
  bool mayEdit = false;        // the visitor gets the page with the editor
  std::string_view cookieName; // for the token
  bool secure = false;         // the visitor uses TLS, with a proxy in between
};
// seconds: time of the clock of the downloads.
Answer answerTo(const Request& request, Downloads& downloads, Images& images, double seconds);

} // namespace vv::server
