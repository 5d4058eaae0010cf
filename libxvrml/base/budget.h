// budget.h: the memory budget of a world (limit worldBytes). Everything made from the world's files
// draws from it. The amounts are estimates from measured constants and the same on every machine,
// so that a world near its limit always loses the same nodes. [any thread]
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "xvrml/limits.h"

namespace xvrml {

class World;
class Decoder; // decode/decoder.h

class Budget {
 public:
  // limit: bytes; 0: defaultWorldBytes().
  explicit Budget(uint64_t limit);
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  // Reserves bytes. Returns false, and reserves nothing, if not enough are left.
  bool take(uint64_t bytes);
  void give(uint64_t bytes) { used_.fetch_sub(bytes, std::memory_order_relaxed); }
  uint64_t limit() const { return limit_; }
  uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  uint64_t left() const;
  // Returns "limit worldBytes=4294967296", for messages.
  std::string name() const;

  // The processes that decode files of the world: pictures and sounds, and STEP models. decoderOf()
  // makes them; they end with the budget.
  std::shared_ptr<Decoder> decoder, stepReader;

 private:
  const uint64_t limit_;
  std::atomic<uint64_t> used_{0};
};

using BudgetPtr = std::shared_ptr<Budget>;

// A reservation of a budget's memory, released when this object is destroyed. Starts with no bytes.
class Share {
 public:
  Share() = default;
  explicit Share(BudgetPtr budget) : budget_(std::move(budget)) {}
  Share(Share&& other) noexcept : budget_(std::move(other.budget_)), bytes_(other.bytes_) {
    other.bytes_ = 0;
  }
  Share& operator=(Share&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~Share() { clear(); }
  // Reserves more bytes. Returns false if not enough are left; without a budget it always succeeds.
  bool take(uint64_t bytes) {
    if (budget_ && !budget_->take(bytes)) return false;
    bytes_ += bytes;
    return true;
  }
  void give(uint64_t bytes) {
    if (budget_) budget_->give(bytes);
    bytes_ -= bytes;
  }
  void clear() { give(bytes_); }
  // Takes over the release of bytes that other code has reserved from the budget.
  void adopt(BudgetPtr budget, uint64_t bytes) {
    clear();
    budget_ = std::move(budget);
    bytes_ = bytes;
  }
  uint64_t bytes() const { return bytes_; }
  const BudgetPtr& budget() const { return budget_; }

 private:
  BudgetPtr budget_;
  uint64_t bytes_ = 0;
};

// Returns an eighth of the memory that this process may use, at least 256 MiB. That memory is the
// smallest of the machine's, the control group's (cgroup v2 or v1) and the address space (ulimit
// -v). It is read once.
uint64_t defaultWorldBytes();

// Returns the budget of a world. The first call makes it, with the limit in world.options. It lives
// as long as the world.
BudgetPtr budgetOf(const World& world);
// Makes a world that is about to be loaded use the budget of the world that it becomes part of.
void setBudget(const World& world, BudgetPtr budget);
// Removes a world's budget. Called by the world's destructor.
void forgetBudget(const World& world) noexcept;

} // namespace xvrml
