#include "control/connection.h"

#include <algorithm>
#include <cerrno>

#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>

#include "system/sockets.h"

namespace vv::control {

namespace {

constexpr size_t readBytes = 65'536;
// These limits hold for a client that was cut off and reads why: seconds, and bytes that it still
// sends.
constexpr double lingering = 10;
constexpr size_t lingeringBytes = size_t(64) << 20;

} // namespace

Connection::~Connection() {
  mailbox_.leave(client_);
  ::close(fd_);
}

bool Connection::wantsToRead() const {
  return !inputEnded_ && !isBroken_ && (isCut_ || !mailbox_.isFull(client_));
}

void Connection::read() {
  char block[readBytes];
  const ssize_t got = ::recv(fd_, block, sizeof block, 0);
  if (got < 0) {
    if (errno != EAGAIN && errno != EINTR) isBroken_ = true;
    return;
  }
  if (got == 0) endSeen_ = inputEnded_ = true;
  if (isCut_) {
    thrownAway_ += size_t(got);
    if (thrownAway_ > lingeringBytes) isBroken_ = true;
    return;
  }
  input_.append(block, size_t(got));
  deliverLines();
}

void Connection::deliverLines() {
  size_t begin = 0;
  while (!isCut_ && !mailbox_.isFull(client_)) {
    size_t end = input_.find('\n', std::max(begin, searched_));
    if (end == input_.npos) {
      searched_ = input_.size();
      if (!inputEnded_ || begin == input_.size()) break;
      end = input_.size(); // the last line has no line feed
    }
    const std::string_view line = std::string_view(input_).substr(begin, end - begin);
    const bool blank = line.find_first_not_of(" \t\r") == line.npos;
    if (!blank && !mailbox_.deliver(client_, line)) isCut_ = true;
    begin = std::min(input_.size(), end + 1);
    searched_ = begin;
  }
  input_.erase(0, begin);
  searched_ -= begin;
  if (!isCut_ && searched_ == input_.size() && input_.size() > limits.lineBytes) {
    mailbox_.cut(client_, "limit",
                 fmt::format("a line is longer than lineBytes={} bytes: this "
                             "client is cut off",
                             limits.lineBytes));
    isCut_ = true;
  }
  if (isCut_) std::string().swap(input_);
}

void Connection::work() {
  if (!isCut_ && !input_.empty()) deliverLines();
  if (!mailbox_.takeOutput(client_, output_)) isCut_ = true;
  send();
}

void Connection::send() {
  while (!isBroken_ && sent_ < output_.size()) {
    const ssize_t put = ::send(fd_, output_.data() + sent_, output_.size() - sent_, os::noSignal);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0 && errno == EAGAIN) break;
    if (put <= 0) isBroken_ = true;
    if (put > 0) sent_ += size_t(put);
  }
  if (sent_ == output_.size()) {
    output_.clear();
    sent_ = 0;
  }
  mailbox_.setUnsent(client_, output_.size() - sent_);
}

// A client that was cut off must be able to read why: closing a socket with unread input would
// throw away what was sent last. So its end is announced, and what it still sends is read for a
// while.
bool Connection::hasEnded(double now) {
  if (isBroken_) return true;
  if (isCut_) {
    if (giveUp_ == 0) giveUp_ = now + lingering;
    if (!wantsToWrite() && !isShut_) {
      ::shutdown(fd_, SHUT_WR);
      isShut_ = true;
    }
    return now > giveUp_ || (isShut_ && inputEnded_);
  }
  return inputEnded_ && input_.empty() && !wantsToWrite() && mailbox_.isIdle(client_);
}

} // namespace vv::control
