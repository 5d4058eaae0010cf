#include "server/answer.h"

#include <algorithm>

#include <fmt/format.h>

#include "server/limits.h"

namespace vv::server {

namespace {

// The page uses nothing but its own files and its own WebSocket, and no other page may frame it.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr std::string_view savedFolder = "saved/", imageFolder = "images/";

std::string typeOf(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  return "image/png";
}

Answer withHeaders(Answer answer) {
  answer.headers.insert(answer.headers.end(), {{"content-security-policy", policy},
                                               {"x-content-type-options", "nosniff"},
                                               {"referrer-policy", "no-referrer"},
                                               {"cross-origin-opener-policy", "same-origin"},
                                               {"cross-origin-resource-policy", "same-origin"}});
  answer.headers.emplace_back("cache-control",
                              answer.mayBeKept ? "private, max-age=86400" : "no-store");
  return answer;
}

Answer textAnswer(int status, std::string_view text) {
  return {status,
          "text/plain; charset=utf-8",
          {},
          std::make_shared<const std::string>(std::string(text) + "\n")};
}

// The token goes from the address into a cookie, so that it is not in the history of the browser.
// The path is relative, because a proxy may serve the page below a folder.
Answer cookieAnswer(const Request& request) {
  Answer answer = textAnswer(303, "The page is at ./");
  answer.headers = {
      {"location", "./"},
      {"set-cookie", fmt::format("{}={}; Path=/; HttpOnly; SameSite=Lax{}", request.cookieName,
                                 request.token, request.secure ? "; Secure" : "")}};
  return answer;
}

// Returns the page with the editor. Other visitors get the page as it is.
std::string withEditor(std::string_view page) {
  constexpr std::string_view script = R"(<script src="page.js" type="module"></script>)";
  std::string text(page);
  if (const size_t at = text.find(script); at != text.npos)
    text.replace(at, script.size(),
                 "<link rel=\"stylesheet\" href=\"edit.css\">\n"
                 "<link rel=\"stylesheet\" href=\"overlay.css\">\n"
                 "<script src=\"edit.js\" type=\"module\"></script>");
  return text;
}

Answer contentOf(const Request& request, std::string_view name, Downloads& downloads,
                 Images& images, double seconds) {
  const bool isPage = name.empty() || name == "page.html";
  if (isPage) name = "page.html";
  if (name.starts_with(savedFolder)) {
    const Downloads::File file = downloads.find(name, seconds);
    if (!file.content) return textAnswer(404, "This picture is not kept any more: save it again.");
    return {200,
            file.type,
            {{"content-disposition", fmt::format("attachment; filename=\"{}\"", file.name)}},
            file.content};
  }
  if (request.mayEdit && name.starts_with(imageFolder))
    if (std::shared_ptr<const std::string> image = images.find(name))
      return {200, "image/png", {}, std::move(image), true};
  for (const PageFile& file : pageFiles())
    if (file.name == name)
      return {200,
              typeOf(name),
              {},
              std::make_shared<const std::string>(isPage && request.mayEdit
                                                      ? withEditor(file.content)
                                                      : std::string(file.content))};
  return textAnswer(404, "There is no such page.");
}

} // namespace

std::string Downloads::offer(std::string name, std::string type, std::string content,
                             double seconds) {
  for (char& c : name) // the name stands in a header and in a path
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '_';
  std::string path = fmt::format("{}{}/{}", savedFolder, newToken(), name);
  const std::lock_guard lock(mutex_);
  drop(seconds);
  if (files_.size() >= size_t(maxDownloads)) files_.pop_front();
  files_.push_back({path, std::move(name), std::move(type),
                    std::make_shared<const std::string>(std::move(content)), seconds});
  return path;
}

Downloads::File Downloads::find(std::string_view path, double seconds) {
  const std::lock_guard lock(mutex_);
  drop(seconds);
  const auto found =
      std::find_if(files_.begin(), files_.end(), [&](const File& f) { return f.path == path; });
  return found == files_.end() ? File{} : *found;
}

void Downloads::drop(double seconds) {
  while (!files_.empty() && seconds - files_.front().offered > maxDownloadSeconds)
    files_.pop_front();
}

std::string Images::add(std::string png) {
  std::string path = fmt::format("{}{}.png", imageFolder, newToken());
  const std::lock_guard lock(mutex_);
  files_.emplace(path, std::make_shared<const std::string>(std::move(png)));
  return path;
}

void Images::remove(const std::string& path) {
  const std::lock_guard lock(mutex_);
  files_.erase(path);
}

std::shared_ptr<const std::string> Images::find(std::string_view path) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : found->second;
}

Answer answerTo(const Request& request, Downloads& downloads, Images& images, double seconds) {
  if (const std::string_view refusal = textOf(request.verdict); !refusal.empty())
    return withHeaders(textAnswer(403, refusal));
  if (request.method != "GET" && request.method != "HEAD") {
    Answer answer = textAnswer(405, "Only GET is understood.");
    answer.headers = {{"allow", "GET, HEAD"}};
    return withHeaders(std::move(answer));
  }
  std::string_view name = request.path;
  if (name.starts_with('/')) name.remove_prefix(1);
  if (request.verdict == Verdict::withQuery && name.empty())
    return withHeaders(cookieAnswer(request));
  return withHeaders(contentOf(request, name, downloads, images, seconds));
}

} // namespace vv::server
