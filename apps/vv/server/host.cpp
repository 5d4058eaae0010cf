#include "server/host.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <libwebsockets.h>

#include "options/values.h"
#include "server/answer.h"
#include "server/flow.h"
#include "server/idle_connections.h"
#include "server/limits.h"
#include "server/server.h"
#include "spare_descriptors.h"
#include "steady_clock.h"

namespace vv::server {

namespace {

constexpr const char* socketPath = "/live";
constexpr size_t bodyBlock = 65536; // bytes of a body that are written at once
constexpr size_t mostTexts = 32;    // texts without a name that wait for a page
constexpr size_t headerRoom = 4096; // for the headers of an answer
constexpr auto tryAgainLater = static_cast<lws_close_status>(1013);

std::string headerOf(lws* connection, lws_token_indexes token) {
  const int length = lws_hdr_total_length(connection, token);
  if (length <= 0) return {};
  std::string text(size_t(length) + 1, '\0');
  const int copied = lws_hdr_copy(connection, text.data(), int(text.size()), token);
  text.resize(copied > 0 ? size_t(copied) : 0);
  return text;
}

// Versions of the library differ in whether the answer begins with "=".
std::string tokenOfQuery(lws* connection) {
  char buffer[maxTokenLength + 16];
  const char* value = lws_get_urlarg_by_name(connection, "token", buffer, int(sizeof buffer));
  if (value && *value == '=') ++value;
  return value ? value : "";
}

bool usesTls(lws* connection) {
#ifdef LWS_WITH_CUSTOM_HEADERS
  constexpr std::string_view name = "x-forwarded-proto:";
  char value[16] = {};
  return lws_hdr_custom_copy(connection, value, int(sizeof value), name.data(), int(name.size())) >
             0 &&
         std::strcmp(value, "https") == 0;
#else
  return (void)connection, false;
#endif
}

// The WebSocket of a page. [the host's thread]
struct Socket {
  lws* connection = nullptr;
  std::string partial; // the message that is arriving
  MessageRate rate;
  std::map<std::string, std::string> named; // texts that a later one replaces
  std::deque<std::string> texts;
  std::string picture;
  std::string refusal; // not empty: why the connection is closed as soon as possible
  bool known = false;  // the server was told of it
  Rights rights = Rights::view;

  bool isSending() const {
    return !refusal.empty() || !named.empty() || !texts.empty() || !picture.empty();
  }
};

// An HTTP request whose body is being sent. [the host's thread]
struct Transfer {
  std::shared_ptr<const std::string> body;
  size_t sent = 0;
};

} // namespace

struct Host::Impl {
  const HostOptions options;
  const std::function<void()> wake;
  lws_context* context = nullptr;
  int port = 0;
  std::string cookieName;
  Downloads downloads;
  Images images;
  std::thread thread;
  std::atomic<bool> ending{false};

  std::mutex mutex;
  std::vector<HostEvent> events;
  struct Order {
    enum class Kind : uint8_t { text, picture, close };
    Kind kind;
    uint64_t page;
    std::string name, bytes; // name: of a text
  };
  std::vector<Order> orders; // what the host's thread is to send

  // Used by the host's thread only.
  std::map<uint64_t, Socket> sockets;
  std::unordered_map<lws*, uint64_t> numbers;
  std::unordered_map<lws*, Transfer> transfers;
  std::unordered_set<lws*> editors; // connections that have shown the edit token
  IdleConnections<lws*> idlers;
  uint64_t lastSocket = 0;

  Impl(const HostOptions& wanted, std::function<void()> wakeOther)
      : options(wanted), wake(std::move(wakeOther)) {}

  // --- The host's thread ---

  static int callback(lws* connection, lws_callback_reasons reason, void*, void* in,
                      size_t length) {
    Impl* const self = static_cast<Impl*>(lws_context_user(lws_get_context(connection)));
    try { // no exception may cross the C frames of the library
      return self ? self->handle(connection, reason, in, length) : 0;
    } catch (...) { return -1; }
  }

  int handle(lws* connection, lws_callback_reasons reason, void* in, size_t length) {
    switch (reason) {
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE: return confirm(connection, static_cast<char*>(in));
    case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED: idle(connection); return 0;
    case LWS_CALLBACK_HTTP:
      idlers.remove(connection);
      return answer(connection, {static_cast<char*>(in), length});
    case LWS_CALLBACK_HTTP_WRITEABLE: return sendBody(connection);
    case LWS_CALLBACK_CLOSED_HTTP: transfers.erase(connection); return 0;
    case LWS_CALLBACK_WSI_DESTROY:
      idlers.remove(connection);
      editors.erase(connection);
      return 0;
    case LWS_CALLBACK_ESTABLISHED:
      idlers.remove(connection);
      join(connection);
      return 0;
    case LWS_CALLBACK_RECEIVE: return receive(connection, {static_cast<char*>(in), length});
    case LWS_CALLBACK_SERVER_WRITEABLE: return sendNext(connection);
    case LWS_CALLBACK_CLOSED: leave(connection); return 0;
    case LWS_CALLBACK_RAW_ADOPT: // CONNECT: such a connection would never be closed
    case LWS_CALLBACK_RAW_CONNECTED:
    case LWS_CALLBACK_RAW_RX: return -1;
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED: takeOrders(); return 0;
    default: return 0;
    }
  }

  // Notes a connection that asks for nothing now.
  void idle(lws* connection) {
    if (lws* const oldest = idlers.add(connection))
      lws_set_timeout(oldest, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
  }

  // Ends an answer. Returns what the callback returns.
  int complete(lws* connection) {
    idle(connection);
    return lws_http_transaction_completed(connection) ? -1 : 0;
  }

  Tokens tokens() const { return {options.token, options.editToken}; }

  // Calls use() with what a browser sends about its user. Returns what that returns.
  template <class Use> auto withCredentials(lws* connection, const Use& use) const {
    const std::string host = headerOf(connection, WSI_TOKEN_HOST),
                      origin = headerOf(connection, WSI_TOKEN_ORIGIN),
                      cookies = headerOf(connection, WSI_TOKEN_HTTP_COOKIE),
                      token = tokenOfQuery(connection);
    return use(Credentials{host, origin, cookieNamed(cookies, cookieName), token});
  }

  // Tells whether a connection may become a WebSocket: 0 yes, 1 no, -1 hang up.
  int confirm(lws* connection, const char* protocol) {
    if (!protocol || ::strcasecmp(protocol, "websocket") != 0) return -1;
    const bool known = headerOf(connection, WSI_TOKEN_GET_URI) == socketPath;
    const std::string_view refusal = withCredentials(connection, [&](const Credentials& shown) {
      // A proxy may send the requests of several visitors on one connection.
      if (mayEdit(shown, tokens()))
        editors.insert(connection);
      else
        editors.erase(connection);
      return textOf(judge(shown, tokens(), Asked::socket));
    });
    if (known && refusal.empty()) return 0;
    const std::string text(known ? refusal : "There is no such page.");
    return lws_return_http_status(connection, known ? 403 : 404, text.c_str()) < 0 ? -1 : 1;
  }

  int answer(lws* connection, std::string_view path) {
    Request request;
    request.path = path;
    withCredentials(connection, [&](const Credentials& shown) {
      request.verdict = judge(shown, tokens());
      request.mayEdit = mayEdit(shown, tokens());
    });
    request.token = request.mayEdit ? options.editToken : options.token;
    request.cookieName = cookieName;
    request.secure = usesTls(connection);
    const bool head = lws_hdr_total_length(connection, WSI_TOKEN_HEAD_URI) > 0;
    request.method = head                                                      ? "HEAD"
                     : lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) > 0 ? "GET"
                                                                               : "";
    const Answer given = answerTo(request, downloads, images, steadySeconds());
    unsigned char room[LWS_PRE + headerRoom];
    unsigned char *const start = room + LWS_PRE, *at = start, *const end = room + sizeof room - 1;
    const size_t size = given.body->size();
    if (lws_add_http_common_headers(connection, unsigned(given.status), given.type.c_str(), size,
                                    &at, end))
      return -1;
    for (const auto& [name, value] : given.headers) {
      const std::string field = name + ":";
      if (lws_add_http_header_by_name(
              connection, reinterpret_cast<const unsigned char*>(field.c_str()),
              reinterpret_cast<const unsigned char*>(value.c_str()), int(value.size()), &at, end))
        return -1;
    }
    if (lws_finalize_write_http_header(connection, start, &at, end)) return -1;
    if (head || size == 0) return complete(connection);
    transfers[connection] = {given.body, 0};
    lws_callback_on_writable(connection);
    return 0;
  }

  int sendBody(lws* connection) {
    const auto found = transfers.find(connection);
    if (found == transfers.end()) return 0;
    Transfer& transfer = found->second;
    const size_t size = std::min(bodyBlock, transfer.body->size() - transfer.sent);
    const bool last = transfer.sent + size == transfer.body->size();
    std::vector<unsigned char> bytes(LWS_PRE + size);
    std::memcpy(bytes.data() + LWS_PRE, transfer.body->data() + transfer.sent, size);
    if (lws_write(connection, bytes.data() + LWS_PRE, size,
                  last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < int(size))
      return -1;
    transfer.sent += size;
    if (!last) {
      lws_callback_on_writable(connection);
      return 0;
    }
    transfers.erase(found);
    return complete(connection);
  }

  // --- WebSockets ---

  void tell(HostEvent event) {
    {
      const std::lock_guard lock(mutex);
      events.push_back(std::move(event));
    }
    wake();
  }

  void join(lws* connection) {
    const uint64_t number = ++lastSocket;
    Socket& socket = sockets[number];
    socket.connection = connection;
    numbers[connection] = number;
    const auto known = std::count_if(sockets.begin(), sockets.end(),
                                     [](const auto& one) { return one.second.known; });
    socket.known = known < maxViewers;
    if (editors.contains(connection)) socket.rights = Rights::edit;
    if (socket.known) return tell({HostEvent::Kind::joined, number, {}, socket.rights});
    socket.refusal = fmt::format("there are {} pages already (maxViewers)", maxViewers);
    lws_callback_on_writable(connection); // sendNext() closes it
  }

  void leave(lws* connection) {
    const auto found = numbers.find(connection);
    if (found == numbers.end()) return;
    const uint64_t number = found->second;
    const bool known = sockets[number].known;
    sockets.erase(number);
    numbers.erase(found);
    if (known) tell({HostEvent::Kind::left, number, {}, {}});
  }

  // Closes a connection with a reason of at most 123 bytes. Returns what the callback returns.
  static int close(lws* connection, lws_close_status status, std::string_view reason) {
    std::string text(reason.substr(0, 120));
    lws_close_reason(connection, status, reinterpret_cast<unsigned char*>(text.data()),
                     text.size());
    return -1;
  }

  int receive(lws* connection, std::string_view bytes) {
    const auto found = numbers.find(connection);
    if (found == numbers.end()) return -1;
    Socket& socket = sockets[found->second];
    if (!socket.refusal.empty()) return 0;
    // A part of a message counts as one, too, because there may be many empty ones.
    if (!socket.rate.allow(steadySeconds()))
      return close(connection, LWS_CLOSE_STATUS_POLICY_VIOLATION, "maxMessagesPerSecond");
    if (lws_frame_is_binary(connection))
      return close(connection, LWS_CLOSE_STATUS_UNACCEPTABLE_OPCODE, "texts were expected");
    const bool edits = socket.rights == Rights::edit;
    if (socket.partial.size() + bytes.size() > size_t(edits ? maxEditBytes : maxMessageBytes))
      return close(connection, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE,
                   edits ? "maxEditBytes" : "maxMessageBytes");
    socket.partial += bytes;
    if (!lws_is_final_fragment(connection)) return 0;
    ReadMessage read = readMessage(std::exchange(socket.partial, {}), socket.rights);
    if (!read.message) return close(connection, LWS_CLOSE_STATUS_POLICY_VIOLATION, read.fault);
    tell({HostEvent::Kind::message, found->second, std::move(*read.message), socket.rights});
    return 0;
  }

  // Sends one message of what waits: texts first, because they are small.
  int sendNext(lws* connection) {
    const auto found = numbers.find(connection);
    if (found == numbers.end()) return -1;
    Socket& socket = sockets[found->second];
    if (!socket.refusal.empty()) return close(connection, tryAgainLater, socket.refusal);
    std::string bytes;
    bool picture = false;
    if (!socket.texts.empty()) {
      bytes = std::move(socket.texts.front());
      socket.texts.pop_front();
    } else if (!socket.named.empty()) {
      bytes = std::move(socket.named.begin()->second);
      socket.named.erase(socket.named.begin());
    } else if (!socket.picture.empty()) {
      bytes = std::exchange(socket.picture, {});
      picture = true;
    } else {
      return 0;
    }
    std::vector<unsigned char> room(LWS_PRE + bytes.size());
    std::memcpy(room.data() + LWS_PRE, bytes.data(), bytes.size());
    if (lws_write(connection, room.data() + LWS_PRE, bytes.size(),
                  picture ? LWS_WRITE_BINARY : LWS_WRITE_TEXT) < 0)
      return -1;
    if (socket.isSending()) lws_callback_on_writable(connection);
    return 0;
  }

  void takeOrders() {
    std::vector<Order> taken;
    {
      const std::lock_guard lock(mutex);
      taken.swap(orders);
    }
    for (Order& order : taken) {
      const auto found = sockets.find(order.page);
      if (found == sockets.end()) continue;
      Socket& socket = found->second;
      if (order.kind == Order::Kind::close)
        socket.refusal = "vv has run out of memory";
      else if (order.kind == Order::Kind::picture)
        socket.picture = std::move(order.bytes);
      else if (!order.name.empty())
        socket.named[order.name] = std::move(order.bytes);
      else
        socket.texts.push_back(std::move(order.bytes));
      if (socket.texts.size() > mostTexts) socket.texts.pop_front();
      lws_callback_on_writable(socket.connection);
    }
  }

  // --- Start and end ---

  void listen();
  bool listenAt(const std::string& address);

  void order(Order one) {
    {
      const std::lock_guard lock(mutex);
      orders.push_back(std::move(one));
    }
    lws_cancel_service(context);
  }
};

namespace {

// The clients of a dead connection are found out by pings; a browser answers them by itself.
constexpr lws_retry_bo_t idlePolicy = [] {
  lws_retry_bo_t policy{};
  policy.secs_since_valid_ping = 20;
  policy.secs_since_valid_hangup = 40;
  return policy;
}();

} // namespace

bool Host::Impl::listenAt(const std::string& address) {
  static const lws_protocols protocols[] = {
      {"vv", callback, 0, size_t(maxMessageBytes), 0, nullptr, 0},
      {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  const bool ip6 = address.find(':') != address.npos;
  lws_context_creation_info info{};
  info.port = port;
  info.iface = address.c_str();
  info.vhost_name = address.c_str();
  info.protocols = protocols;
  info.retry_and_idle_policy = &idlePolicy;
  info.options = ip6 ? LWS_SERVER_OPTION_IPV6_V6ONLY_MODIFY | LWS_SERVER_OPTION_IPV6_V6ONLY_VALUE
                     : LWS_SERVER_OPTION_DISABLE_IPV6;
  // Otherwise the library waits silently for an address that the machine might get later.
  info.options |= LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  lws_vhost* const host = lws_create_vhost(context, &info);
  if (!host) return false;
  if (const int used = lws_get_vhost_listen_port(host); used > 0) port = used;
  return true;
}

void Host::Impl::listen() {
  // The library would start, but not listen, and could not be woken.
  constexpr int descriptors = 12; // its own, the sockets that listen, and a few connections
  needDescriptors(descriptors, "vv serve");
  lws_set_log_level(0, nullptr); // a library never prints
  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  info.user = this;
  info.fd_limit_per_thread = unsigned(maxRequests + maxViewers);
  context = lws_create_context(&info);
  if (!context) throw Failure{exitTryAgain, "vv serve: libwebsockets could not be started"};
  port = options.port;
  bool first = true;
  for (const std::string& address : options.addresses) {
    if (!listenAt(address) && first)
      throw Failure{exitRender,
                    fmt::format("vv serve: cannot listen at {} port {}: the port is in use, or "
                                "this machine does not have the address",
                                address, options.port)};
    first = false;
  }
  cookieName = fmt::format("vv-token-{}", port);
}

bool isIpAddress(const std::string& text) {
  uint8_t bytes[16];
  return lws_parse_numeric_address(text.c_str(), bytes, sizeof bytes) > 0;
}

Host::Host(const HostOptions& options, std::function<void()> wake)
    : impl_(std::make_unique<Impl>(options, std::move(wake))) {
  try {
    impl_->listen();
  } catch (...) {
    if (impl_->context) lws_context_destroy(impl_->context);
    throw;
  }
  impl_->thread = std::thread([impl = impl_.get()] {
    while (!impl->ending && lws_service(impl->context, 0) >= 0) {}
  });
}

Host::~Host() {
  impl_->ending = true;
  lws_cancel_service(impl_->context);
  impl_->thread.join();
  lws_context_destroy(impl_->context);
}

int Host::port() const { return impl_->port; }

std::vector<HostEvent> Host::takeEvents() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->events, {});
}

void Host::sendText(uint64_t page, const std::string& name, std::string text) {
  impl_->order({Impl::Order::Kind::text, page, name, std::move(text)});
}

void Host::sendPicture(uint64_t page, std::string bytes) {
  impl_->order({Impl::Order::Kind::picture, page, {}, std::move(bytes)});
}

void Host::close(uint64_t page) { impl_->order({Impl::Order::Kind::close, page, {}, {}}); }

std::string Host::offerDownload(std::string name, std::string type, std::string content) {
  return impl_->downloads.offer(std::move(name), std::move(type), std::move(content),
                                steadySeconds());
}

std::string Host::keepImage(std::string png) { return impl_->images.add(std::move(png)); }
void Host::dropImage(const std::string& path) { impl_->images.remove(path); }

} // namespace vv::server

std::string vv::serverLibrary() {
  return std::string("libwebsockets ") + lws_get_library_version();
}
