// server_access.cpp: Tests who may see the page and steer the world, and what a request gets.
#include <chrono>
#include <set>

#include <gtest/gtest.h>

#include "server/access.h"
#include "server/answer.h"
#include "server/limits.h"

namespace vv::server {

// Stands for the files that CMake puts into vv.
std::span<const PageFile> pageFiles() {
  static const PageFile files[] = {
      {"page.html", R"(<html><script src="page.js" type="module"></script>)"}, {"page.js", "js"}};
  return files;
}

namespace {

constexpr const char* secret = "0123456789abcdef";

Verdict verdict(Credentials credentials, std::string_view token) {
  return judge(credentials, {token, {}});
}

TEST(ServerAccess, TextsAreComparedAsAWhole) {
  EXPECT_TRUE(equalInConstantTime("", ""));
  EXPECT_TRUE(equalInConstantTime(secret, "0123456789abcdef"));
  EXPECT_FALSE(equalInConstantTime(secret, "0123456789abcdeg"));
  EXPECT_FALSE(equalInConstantTime(secret, "1123456789abcdef"));
  EXPECT_FALSE(equalInConstantTime(secret, "0123456789abcde"));
  EXPECT_FALSE(equalInConstantTime(secret, ""));
}

TEST(ServerAccess, TokensAreLongAndPlain) {
  EXPECT_EQ(faultOfToken(secret), "");
  EXPECT_NE(faultOfToken("0123456789abcde"), "");
  EXPECT_NE(faultOfToken(std::string(size_t(maxTokenLength) + 1, 'a')), "");
  for (const char* text : {"0123456789abcde;", "0123456789abcde ", "0123456789abcd\r\n",
                           "0123456789abcde%", "0123456789abcde\xc3"})
    EXPECT_NE(faultOfToken(text), "") << text;
  std::set<std::string> made;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(faultOfToken(newToken()), "");
    made.insert(newToken());
  }
  EXPECT_EQ(made.size(), 100u);
}

TEST(ServerAccess, CookiesAreFoundByTheirWholeName) {
  EXPECT_EQ(cookieNamed("a=1; vv-token-80=xyz; b=2", "vv-token-80"), "xyz");
  EXPECT_EQ(cookieNamed("vv-token-80=x", "vv-token-80"), "x");
  EXPECT_EQ(cookieNamed("avv-token-80=x; vv-token-801=y", "vv-token-80"), "");
  EXPECT_EQ(cookieNamed("; ;vv-token-80", "vv-token-80"), "");
  EXPECT_EQ(cookieNamed("", "vv-token-80"), "");
}

TEST(ServerAccess, LoopbackHostsNameThisMachine) {
  for (const char* host : {"localhost", "LocalHost:8097", "127.0.0.1", "127.0.0.1:80", "127.1.2.3",
                           "[::1]", "[::1]:8097"})
    EXPECT_TRUE(isLoopbackHost(host)) << host;
  for (const char* host : {"", "example.org", "localhost.example.org", "127.0.0.1.example.org",
                           "127.0.0", "127..0.1", "localhost:", "localhost:a", "[::1].example.org",
                           "[::1]:80a", "127.0.0.1.", "10.0.0.1", "[::2]", "[::1", "::1"})
    EXPECT_FALSE(isLoopbackHost(host)) << host;
}

TEST(ServerAccess, OriginsHaveHostAndPort) {
  EXPECT_TRUE(isSameOrigin("http://localhost:8097", "localhost:8097"));
  EXPECT_TRUE(isSameOrigin("https://vv.example.org", "VV.example.org"));
  EXPECT_TRUE(isSameOrigin("https://vv.example.org:443", "vv.example.org"));
  EXPECT_TRUE(isSameOrigin("http://vv.example.org", "vv.example.org:80"));
  EXPECT_FALSE(isSameOrigin("http://localhost:8098", "localhost:8097"));
  EXPECT_FALSE(isSameOrigin("https://evil.example", "vv.example.org"));
  EXPECT_FALSE(isSameOrigin("https://vv.example.org:80", "vv.example.org"));
  EXPECT_FALSE(isSameOrigin("null", "localhost:8097"));
  EXPECT_FALSE(isSameOrigin("file://localhost:8097", "localhost:8097"));
  EXPECT_FALSE(isSameOrigin("http://", ""));
}

TEST(ServerAccess, WithoutATokenOnlyThisMachineIsServed) {
  EXPECT_EQ(verdict({"localhost:8097", "", "", ""}, ""), Verdict::allowed);
  EXPECT_EQ(verdict({"localhost:8097", "http://localhost:8097", "", ""}, ""), Verdict::allowed);
  EXPECT_EQ(verdict({"localhost:8097", "http://evil.example", "", ""}, ""), Verdict::wrongOrigin);
  // A foreign page whose name leads to this machine.
  EXPECT_EQ(verdict({"evil.example:8097", "http://evil.example:8097", "", ""}, ""),
            Verdict::wrongHost);
  EXPECT_EQ(verdict({"", "", "", ""}, ""), Verdict::wrongHost);
}

TEST(ServerAccess, AWebSocketSaysWhichPageHasOpenedIt) {
  using vv::server::Asked;
  const auto socket = [](const Credentials& c, std::string_view token) {
    return judge(c, {token, {}}, Asked::socket);
  };
  EXPECT_EQ(socket({"localhost:8097", "", "", ""}, ""), Verdict::noOrigin);
  EXPECT_EQ(socket({"localhost:8097", "http://localhost:8097", "", ""}, ""), Verdict::allowed);
  EXPECT_EQ(socket({"vv.example.org", "", secret, ""}, secret), Verdict::noOrigin);
  EXPECT_EQ(socket({"evil.example", "", "", ""}, ""), Verdict::wrongHost);
}

TEST(ServerAccess, ATokenComesByQueryOrCookie) {
  const std::string_view host = "vv.example.org";
  EXPECT_EQ(verdict({host, "", "", ""}, secret), Verdict::tokenMissing);
  EXPECT_EQ(verdict({host, "", "", secret}, secret), Verdict::withQuery);
  EXPECT_EQ(verdict({host, "https://vv.example.org", secret, ""}, secret), Verdict::allowed);
  EXPECT_EQ(verdict({host, "", "0123456789abcdeg", ""}, secret), Verdict::wrongToken);
  EXPECT_EQ(verdict({host, "", "", "0123456789abcdeg"}, secret), Verdict::wrongToken);
  EXPECT_EQ(verdict({host, "https://evil.example", secret, ""}, secret), Verdict::wrongOrigin);
}

TEST(ServerAccess, TheEditTokenOpensThePageAndTheEditor) {
  const std::string_view host = "localhost:8097", other = "fedcba9876543210";
  const Tokens both{secret, other}, editOnly{"", other}, viewOnly{secret, ""};
  EXPECT_EQ(judge({host, "", "", other}, both), Verdict::withQuery);
  EXPECT_EQ(judge({host, "", other, ""}, both), Verdict::allowed);
  EXPECT_EQ(judge({host, "", other, ""}, viewOnly), Verdict::wrongToken);
  EXPECT_EQ(judge({host, "", "", other}, editOnly), Verdict::withQuery);
  EXPECT_EQ(judge({host, "", "", secret}, editOnly), Verdict::allowed);
  EXPECT_EQ(judge({host, "", "", ""}, editOnly), Verdict::allowed);
  EXPECT_EQ(judge({"evil.example", "", other, ""}, editOnly), Verdict::wrongHost);
  EXPECT_TRUE(mayEdit({host, "", "", other}, both));
  EXPECT_TRUE(mayEdit({host, "", other, ""}, editOnly));
  EXPECT_FALSE(mayEdit({host, "", secret, secret}, both));
  EXPECT_FALSE(mayEdit({host, "", "", ""}, both));
  EXPECT_FALSE(mayEdit({host, "", "", ""}, viewOnly));
}

Answer answered(const Request& request, Downloads& downloads) {
  Images none;
  return answerTo(request, downloads, none, 0);
}

Answer answerFor(Verdict verdict, std::string_view path, Downloads& downloads) {
  Request request;
  request.method = "GET";
  request.path = path;
  request.verdict = verdict;
  request.token = secret;
  request.cookieName = "vv-token-80";
  return answered(request, downloads);
}

TEST(ServerAnswer, OnlyEditorsGetTheEditor) {
  Downloads downloads;
  Request request;
  request.method = "GET";
  request.path = "/";
  request.verdict = Verdict::allowed;
  EXPECT_EQ(*answered(request, downloads).body, pageFiles()[0].content);
  request.mayEdit = true;
  const std::string page = *answered(request, downloads).body;
  EXPECT_NE(page.find("edit.css"), std::string::npos);
  EXPECT_NE(page.find(R"(<script src="edit.js" type="module">)"), std::string::npos);
  EXPECT_EQ(page.find("page.js"), std::string::npos);
}

std::string headerOf(const Answer& answer, std::string_view name) {
  for (const auto& [one, value] : answer.headers)
    if (one == name) return value;
  return "";
}

TEST(ServerAnswer, EveryAnswerHasThePolicy) {
  Downloads downloads;
  for (const Verdict verdict :
       {Verdict::allowed, Verdict::withQuery, Verdict::wrongHost, Verdict::wrongOrigin,
        Verdict::noOrigin, Verdict::tokenMissing, Verdict::wrongToken})
    for (const char* path : {"/", "/page.js", "/nothing", "/saved/x/y.png"}) {
      const Answer answer = answerFor(verdict, path, downloads);
      EXPECT_NE(headerOf(answer, "content-security-policy").find("default-src 'none'"),
                std::string::npos);
      EXPECT_EQ(headerOf(answer, "x-content-type-options"), "nosniff");
      ASSERT_TRUE(answer.body);
      const bool allowed = verdict == Verdict::allowed || verdict == Verdict::withQuery;
      EXPECT_EQ(answer.status == 403, !allowed);
      EXPECT_TRUE(allowed || answer.body->find("<html>") == std::string::npos);
    }
}

TEST(ServerAnswer, TheTokenOfTheAddressBecomesACookie) {
  Downloads downloads;
  const Answer answer = answerFor(Verdict::withQuery, "/", downloads);
  EXPECT_EQ(answer.status, 303);
  EXPECT_EQ(headerOf(answer, "location"), "./");
  EXPECT_EQ(headerOf(answer, "set-cookie"),
            std::string("vv-token-80=") + secret + "; Path=/; HttpOnly; SameSite=Lax");
  EXPECT_EQ(*answerFor(Verdict::allowed, "/", downloads).body, pageFiles()[0].content);
}

TEST(ServerAnswer, FilesAreFoundByTheirWholeName) {
  Downloads downloads;
  EXPECT_EQ(*answerFor(Verdict::allowed, "/page.js", downloads).body, "js");
  for (const char* path : {"/page", "/../page.js", "/page.js/", "/page.html2", "//"})
    EXPECT_EQ(answerFor(Verdict::allowed, path, downloads).status, 404) << path;
}

TEST(ServerAnswer, ImagesAreForEditorsAndKept) {
  Downloads downloads;
  Images images;
  const std::string path = images.add("png");
  Request request;
  request.method = "GET";
  const std::string address = "/" + path;
  request.path = address;
  request.verdict = Verdict::allowed;
  EXPECT_EQ(answerTo(request, downloads, images, 0).status, 404);
  request.mayEdit = true;
  const Answer answer = answerTo(request, downloads, images, 0);
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.type, "image/png");
  EXPECT_EQ(*answer.body, "png");
  EXPECT_EQ(headerOf(answer, "cache-control"), "private, max-age=86400");
  EXPECT_EQ(headerOf(answered(request, downloads), "cache-control"), "no-store");
  images.remove(path);
  EXPECT_EQ(answerTo(request, downloads, images, 0).status, 404);
}

TEST(ServerAnswer, OnlyGetIsUnderstood) {
  Downloads downloads;
  Request request;
  request.method = "POST";
  request.path = "/";
  request.verdict = Verdict::allowed;
  EXPECT_EQ(answered(request, downloads).status, 405);
}

TEST(ServerAnswer, SavedPicturesAreKeptForAWhile) {
  Downloads downloads;
  const std::string path = downloads.offer("a \"b\".png", "image/png", "bytes", 10);
  EXPECT_TRUE(path.starts_with("saved/"));
  EXPECT_TRUE(path.ends_with("/a__b_.png"));
  const Downloads::File file = downloads.find(path, 10 + maxDownloadSeconds);
  ASSERT_TRUE(file.content);
  EXPECT_EQ(*file.content, "bytes");
  EXPECT_EQ(file.name, "a__b_.png");
  EXPECT_FALSE(downloads.find("saved/0/a__b_.png", 10).content);
  EXPECT_FALSE(downloads.find(path, 11 + maxDownloadSeconds).content);
}

TEST(ServerAnswer, TheOldestSavedPictureGoesFirst) {
  Downloads downloads;
  std::vector<std::string> paths;
  for (int i = 0; i <= maxDownloads; ++i)
    paths.push_back(downloads.offer("a.png", "image/png", "x", i));
  EXPECT_FALSE(downloads.find(paths.front(), maxDownloads).content);
  for (size_t i = 1; i < paths.size(); ++i)
    EXPECT_TRUE(downloads.find(paths[i], maxDownloads).content);
}

} // namespace
} // namespace vv::server
