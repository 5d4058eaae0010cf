// budget.h: the memory that one world may take: everything made from its files draws from one
// budget (limit worldBytes). What is drawn is an estimate by constants that were measured, the same
// on every machine, so that a world near its limit loses the same nodes each time. [any thread]
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "xvrml/limits.h"

namespace xvrml {

class World;

class Budget {
 public:
  // limit: bytes; 0: defaultWorldBytes().
  explicit Budget(uint64_t limit);
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  // Takes bytes; false if there are not enough left, and then nothing is taken.
  bool take(uint64_t bytes);
  void give(uint64_t bytes) { used_.fetch_sub(bytes, std::memory_order_relaxed); }
  uint64_t limit() const { return limit_; }
  uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  uint64_t left() const;
  // "limit worldBytes=4294967296", for messages.
  std::string name() const;

 private:
  const uint64_t limit_;
  std::atomic<uint64_t> used_{0};
};

using BudgetPtr = std::shared_ptr<Budget>;

// Memory that is taken from a budget as long as this object lives. Starts with none.
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
  // Takes more bytes; false if there are not enough. Without a budget there are always enough.
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
  // Makes bytes its own that somebody else has taken from the budget.
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

// Returns an eighth of the memory that this process may use: of the machine, of its control group
// (cgroup v2 or v1), or of its address space (ulimit -v), whichever is least; 256 MiB at least.
// Read once.
uint64_t defaultWorldBytes();

// Returns the budget of a world, made when it is first asked for by the limit in world.options. It
// ends with the world.
BudgetPtr budgetOf(const World& world);
// Gives a world that is about to be loaded the budget of another one, of which it becomes part.
void setBudget(const World& world, BudgetPtr budget);
// For the end of a world.
void forgetBudget(const World& world) noexcept;

} // namespace xvrml
