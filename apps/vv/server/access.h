// access.h: Decides who may see the page and steer the world, from what a browser sends with its
// request. Pure functions of texts. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vv::server {

// Tells whether texts are equal in a time that does not depend on where they differ.
bool equalInConstantTime(std::string_view a, std::string_view b);

// Returns why a text cannot be a token; empty if it can. A token needs no encoding in a URL.
std::string faultOfToken(std::string_view token);
// Returns 128 random bits as a token. Throws std::system_error if the system has none.
std::string newToken();

// Returns the value of a cookie from the header Cookie; empty if it is not there.
std::string_view cookieNamed(std::string_view header, std::string_view name);

// Tells whether the header Host names this machine itself: localhost, or a loopback address, with
// or without a port.
bool isLoopbackHost(std::string_view host);
// Tells whether the page that Origin names comes from the same host and port as Host.
bool isSameOrigin(std::string_view origin, std::string_view host);

// The parts of a request that matter here. An absent header is empty.
struct Credentials {
  std::string_view host, origin, cookie; // headers; cookie: the value of our cookie
  std::string_view token;                // the token of the query
};
// The tokens in use. Without a view token only this machine may ask, and without an edit token
// nobody may edit. Who has the edit token may look, too.
struct Tokens {
  std::string_view view, edit; // empty: none
};
// A page, or a WebSocket, which must say which page has opened it.
enum class Asked : uint8_t { page, socket };

enum class Verdict {
  allowed,
  withQuery,    // allowed, by the token in the query: it can be replaced by the cookie
  wrongHost,    // no view token is in use, and the name of the host is not that of this machine
  wrongOrigin,  // a page of another site asks
  noOrigin,     // a WebSocket does not say which page has opened it
  tokenMissing, // neither cookie nor query has a token
  wrongToken
};
Verdict judge(const Credentials& credentials, const Tokens& tokens, Asked asked = Asked::page);
// Tells whether a visitor who is allowed has the edit token, in the query or in the cookie.
bool mayEdit(const Credentials& credentials, const Tokens& tokens);
// Returns what the visitor is told; empty for the first two verdicts.
std::string_view textOf(Verdict verdict);

} // namespace vv::server
