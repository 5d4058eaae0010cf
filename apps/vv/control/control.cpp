#include "control/control.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "control/client.h"
#include "control/listener.h"
#include "control/rendering.h"
#include "control/world_commands.h"
#include "process/messages.h"
#include "report/describe.h"

namespace vv::control {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int protocol = 1;
// The longest time for the commands of one turn, so that pictures and input go on.
constexpr std::chrono::milliseconds turn{50};

KeyRing keysOf(const Options& options) {
  return options.cluster.key.empty() ? KeyRing()
                                     : readKeys(options.cluster.key, options.cluster.allow);
}

template <class... Actions> bool isOneOf(const Command& command) {
  return (std::holds_alternative<Actions>(command.action) || ...);
}
bool needsWorld(const Command& command) { return !isOneOf<Hello, Load, Quit>(command); }
bool picks(const Command& command) { return isOneOf<Pick, Probe>(command); }

// A camera shader makes the rays of the picture, which no pick follows.
void refuseCameraShader(const Options& options, Session& session) {
  if (options.view.shader || session.pilot().camera().shader)
    throw CommandError("failed", "a camera shader makes the rays of the picture: nothing can be "
                                 "picked in it");
}

} // namespace

struct Control::Impl {
  const Options& options;
  Host host;
  Mailbox mailbox;
  std::map<ClientId, Client> clients; // those that have sent something
  uint64_t arrived = 0;               // letters so far

  Session* session = nullptr;
  uint64_t generation = 0; // the browser's generation in the session
  // The client that something is rendered for; 0: none. Others wait for their turn.
  ClientId renderer = 0;
  Rendering rendering;
  bool hasQuit = false; // a client has ended vv: nothing more is done
  // A world is being read. Commands that load others wait, so that only one is read at a time.
  bool loading = false;

  std::unique_ptr<Listener> listener; // destroyed first: its thread uses the mailbox

  Impl(const Options& options, Host host)
      : options(options), host(std::move(host)), rendering(options),
        listener(listenAt(Address::parse(options.control), keysOf(options), mailbox)) {}

  // --- Letters ---

  void collect() {
    while (std::optional<Letter> letter = mailbox.take()) {
      Client& client = clients[letter->client];
      client.id = letter->client;
      if (letter->kind == Letter::Kind::left)
        client.hasLeft = true;
      else
        client.waiting.push_back({std::move(*letter), ++arrived});
    }
  }

  // Forgets clients that have left, with what they hold of the world. All that they sent is done
  // first.
  void bury() {
    for (auto at = clients.begin(); at != clients.end();) {
      Client& client = at->second;
      if (client.hasLeft && client.waiting.empty() && client.busy == Client::Busy::no) {
        if (session) WorldCommands::unsubscribeAll(session->browser(), client);
        at = clients.erase(at);
      } else {
        ++at;
      }
    }
  }

  // Returns the client whose command arrived first, of those that may go on.
  Client* next() {
    Client* first = nullptr;
    for (auto& [id, client] : clients) {
      if (client.waiting.empty() || client.busy != Client::Busy::no) continue;
      const Line& line = client.waiting.front().letter.line;
      if (loading && line.command &&
          (isOneOf<Load, Recover>(*line.command) || (!session && needsWorld(*line.command))))
        continue;
      if (line.command && Rendering::makes(*line.command) && !rendering.isFree(session)) continue;
      if (line.command && picks(*line.command) && session && !session->viewers().own().isPlaced())
        continue;
      if (!first || client.waiting.front().order < first->waiting.front().order) first = &client;
    }
    return first;
  }

  // --- Answers ---

  void answer(const Letter& letter, const std::string& result) {
    const Line& line = letter.line;
    if (!line.command || !line.command->quiet)
      send(letter.client, line.id,
           fmt::format(R"({{"id":{},"result":{}}})", line.id.empty() ? "null" : line.id, result));
    mailbox.processed(letter.client, letter.bytes);
  }

  void send(ClientId client, const std::string& id, const std::string& line) {
    if (line.size() <= limits.unreadBytes) return mailbox.send(client, line);
    mailbox.send(client, errorAnswer(id, "limit",
                                     fmt::format("the answer has more than unreadBytes={} bytes",
                                                 limits.unreadBytes)));
  }

  void refuse(const Letter& letter, std::string_view code, std::string_view message) {
    std::string text(message);
    // name the command where the message does not
    if (letter.line.command && !message.starts_with(letter.line.command->name + ":"))
      text = fmt::format("{}: {}", letter.line.command->name, message);
    mailbox.send(letter.client, errorAnswer(letter.line.id, code, text));
    mailbox.processed(letter.client, letter.bytes);
  }

  // Answers the command that a client waits for.
  void finish(Client& client, const std::string& result, std::string_view code,
              const std::string& failure) {
    client.busy = Client::Busy::no;
    const Letter letter = std::exchange(client.underWay, {});
    if (failure.empty())
      answer(letter, result);
    else
      refuse(letter, code, failure);
  }

  // Refuses all that waits: edits behind "quit" would be lost.
  void refuseWaiting(std::string_view why) {
    for (auto& [id, client] : clients)
      for (const auto& one : std::exchange(client.waiting, {})) refuse(one.letter, "refused", why);
  }

  // --- Commands ---

  // Does the first command of a client.
  void doOne(Client& client) {
    Letter letter = std::move(client.waiting.front().letter);
    client.waiting.pop_front();
    client.isServed = true;
    const Line& line = letter.line;
    if (!line.command) return refuse(letter, line.code, line.message);
    try {
      perform(client, letter);
    } catch (const CommandError& error) {
      refuse(letter, error.code, error.what());
    } catch (const xvrml::EditError& error) {
      refuse(letter, "edit", error.what());
    } catch (const Failure& failure) {
      refuse(letter, "file", failure.text);
    } catch (const std::bad_alloc&) {
      refuse(letter, "limit", "not enough memory");
    } catch (const std::exception& error) { refuse(letter, "failed", error.what()); }
  }

  void perform(Client& client, Letter& letter) {
    const Command& command = *letter.line.command;
    if (needsWorld(command) && !session)
      throw CommandError("world", "no world is loaded; \"load\" loads one");
    if (picks(command)) refuseCameraShader(options, *session);
    if (std::holds_alternative<Hello>(command.action)) {
      answer(letter, hello());
    } else if (const auto* quit = std::get_if<Quit>(&command.action)) {
      if (quit->discard && session) session->editor().journal().throwAway();
      answer(letter, "null");
      host.quit();
      hasQuit = true;
    } else if (const auto* load = std::get_if<Load>(&command.action)) {
      if (load->urls.empty()) throw CommandError("command", "load: url: the array is empty");
      if (std::find(load->urls.begin(), load->urls.end(), "-") != load->urls.end())
        throw CommandError("world", "load: \"-\" is standard input, which belongs to the one who "
                                    "started vv; the path of a file was expected");
      open(client, letter, {load->urls, "", {}});
    } else if (const auto* recover = std::get_if<Recover>(&command.action);
               recover && recover->use) {
      open(client, letter,
           {{session->browser().world().path}, "", {}, session->editor().journal().take()});
    } else if (Rendering::makes(command)) {
      rendering.begin(command, *session, [&](const Pick& place) {
        return WorldCommands(*session, client, mailbox).pick(place);
      });
      renderer = client.id;
      client.busy = Client::Busy::rendering;
      client.underWay = std::move(letter);
    } else {
      answer(letter, WorldCommands(*session, client, mailbox).perform(command));
      noticeOtherWorld();
    }
  }

  // Loads a world for a client, who waits for it.
  void open(Client& client, Letter& letter, LoadRequest request) {
    host.open(std::move(request));
    loading = true;
    client.busy = Client::Busy::loading;
    client.underWay = std::move(letter);
  }

  std::string hello() const {
    return fmt::format(R"({{"program":"vv","version":{},"protocol":{},"world":{}}})",
                       jsonText(version()), protocol,
                       session ? jsonText(session->browser().world().path) : "null");
  }

  void followRendering() {
    if (renderer == 0) return;
    const std::optional<Rendering::Outcome> outcome = rendering.follow(session);
    if (!outcome) return;
    Client& client = clients.at(std::exchange(renderer, 0)); // busy clients stay
    finish(client, outcome->result, outcome->code, outcome->failure);
  }

  // --- Worlds ---

  void attach(Session* fresh) {
    if (session == fresh) return;
    session = fresh;
    if (!session) return;
    generation = session->browser().generation();
    for (auto& [id, client] : clients)
      if (client.busy == Client::Busy::loading)
        finish(client, jsonText(session->browser().world().path), "", "");
    tellWorld();
  }

  // A client or a Script may have replaced the nodes of the world.
  void noticeOtherWorld() {
    if (!session || session->browser().generation() == generation) return;
    generation = session->browser().generation();
    tellWorld();
  }

  // Tells the clients that have seen another world, or none. To the others it is no news: their
  // first command waits.
  void tellWorld() {
    const std::string line =
        fmt::format(R"({{"event":"world","world":{}}})", jsonText(session->browser().world().path));
    for (const auto& [id, client] : clients)
      if (client.isServed) mailbox.send(id, line);
  }

  void detach(const char* why) {
    if (renderer != 0 && !rendering.isEncoding()) {
      rendering.giveUp(session);
      finish(clients.at(std::exchange(renderer, 0)), "", "render",
             fmt::format("{} before the picture was finished", why));
    }
    for (auto& [id, client] : clients) {
      if (session) WorldCommands::unsubscribeAll(session->browser(), client);
      client.numbers.releaseAll();
    }
    session = nullptr;
  }

  // Answers what is under way. A picture that is being written gets a moment.
  void end() {
    constexpr double patience = .5; // seconds
    if (rendering.waitForFile(patience)) followRendering();
    rendering.giveUp(session);
    detach("vv ended");
    collect();
    refuseWaiting("vv has ended");
  }

  bool serve(Session* current, bool isLoading) {
    collect();
    if (current && !current->isFree()) return false;
    attach(current);
    noticeOtherWorld();
    followRendering();
    loading = isLoading;
    const Clock::time_point end = Clock::now() + turn;
    for (Client* client = next(); client && !hasQuit; client = next()) {
      doOne(*client);
      if (Clock::now() > end) break;
    }
    bury();
    return session && (session->pictures().stillWaits() || session->measuring().isWaiting());
  }
};

Control::Control(const Options& options, Host host)
    : impl_(std::make_unique<Impl>(options, std::move(host))) {
  say("vv: control: listening at " + impl_->listener->address());
}

Control::~Control() { impl_->end(); }

bool Control::serve(Session* session, bool isLoading) { return impl_->serve(session, isLoading); }

void Control::detach() { impl_->detach("the world was replaced"); }

void Control::loadFailed(const std::string& why) {
  for (auto& [id, client] : impl_->clients)
    if (client.busy == Client::Busy::loading) impl_->finish(client, "", "world", why);
}

void Control::wait(double seconds) { impl_->mailbox.wait(seconds); }

bool Control::isWriting() { return Encoding::working(); }

bool Control::isBusy() const {
  return std::any_of(impl_->clients.begin(), impl_->clients.end(), [](const auto& one) {
    return !one.second.waiting.empty() || one.second.busy != Client::Busy::no;
  });
}

} // namespace vv::control
