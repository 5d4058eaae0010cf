#include "control/mailbox.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace vv::control {

ClientId Mailbox::join(std::function<void()> wake, std::string& why) {
  const std::lock_guard lock(mutex_);
  if (clients_.size() >= limits.clients) {
    why = fmt::format("clients={} clients are connected already", limits.clients);
    return 0;
  }
  Client& client = clients_[++last_];
  client.wake = std::move(wake);
  return last_;
}

void Mailbox::leave(ClientId id) {
  {
    const std::lock_guard lock(mutex_);
    if (clients_.erase(id) == 0) return;
    Letter letter;
    letter.kind = Letter::Kind::left;
    letter.client = id;
    letters_.push_back(std::move(letter));
  }
  arrived_.notify_all();
}

bool Mailbox::deliver(ClientId id, std::string_view text) {
  Letter letter;
  letter.client = id;
  letter.line = readLine(text); // outside of the lock, because it may take long
  letter.bytes = text.size() + 1;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end() || found->second.isCut) return false;
    Client& client = found->second;
    if (!client.isKnown && letter.line.code == "syntax") {
      cut(client, "syntax",
          letter.line.message + "; each line must be a JSON object (docs/control.md)");
      return false;
    }
    client.isKnown = true;
    client.waitingBytes += letter.bytes;
    letters_.push_back(std::move(letter));
  }
  arrived_.notify_all();
  return true;
}

void Mailbox::cut(ClientId id, std::string_view code, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (const auto found = clients_.find(id); found != clients_.end()) cut(found->second, code, why);
}

void Mailbox::cut(Client& client, std::string_view code, const std::string& why) {
  if (client.isCut) return;
  client.output += errorAnswer("", code, why) + "\n";
  client.isCut = true;
  client.wake();
}

bool Mailbox::isFull(ClientId id) const {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(id);
  return found != clients_.end() && found->second.waitingBytes > limits.waitingBytes;
}

bool Mailbox::isIdle(ClientId id) const {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(id);
  return found == clients_.end() ||
         (found->second.waitingBytes == 0 && found->second.output.empty());
}

bool Mailbox::takeOutput(ClientId id, std::string& out) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(id);
  if (found == clients_.end()) return false;
  out += found->second.output;
  found->second.unsent += found->second.output.size();
  found->second.output.clear();
  return !found->second.isCut;
}

void Mailbox::setUnsent(ClientId id, size_t bytes) {
  const std::lock_guard lock(mutex_);
  if (const auto found = clients_.find(id); found != clients_.end()) found->second.unsent = bytes;
}

std::optional<Letter> Mailbox::take() {
  const std::lock_guard lock(mutex_);
  if (letters_.empty()) return {};
  Letter letter = std::move(letters_.front());
  letters_.pop_front();
  return letter;
}

size_t Mailbox::waiting() const {
  const std::lock_guard lock(mutex_);
  return letters_.size();
}

void Mailbox::processed(ClientId id, size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const bool wasFull = client.waitingBytes > limits.waitingBytes;
  client.waitingBytes -= bytes;
  // it may be read again, or end
  if (client.waitingBytes == 0 || (wasFull && client.waitingBytes <= limits.waitingBytes))
    client.wake();
}

void Mailbox::append(Client& client, std::string_view line) {
  if (client.isCut) return;
  if (client.output.size() + client.unsent + line.size() > limits.unreadBytes)
    return cut(client, "limit",
               fmt::format("this client has not read unreadBytes={} bytes of answers and events: "
                           "it is cut off",
                           limits.unreadBytes));
  client.output += line;
  client.output += '\n';
  client.wake();
}

void Mailbox::send(ClientId id, std::string_view line) {
  const std::lock_guard lock(mutex_);
  if (const auto found = clients_.find(id); found != clients_.end()) append(found->second, line);
}

void Mailbox::wait(double seconds) {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, std::chrono::duration<double>(seconds),
                    [this] { return !letters_.empty(); });
}

} // namespace vv::control
