// viewed.cpp: a table of the living views, by the address of the field's storage. There is at most
// one view of each value.
#include "xvrml/viewed.h"

#include <atomic>
#include <mutex>
#include <unordered_map>

#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

struct Table {
  struct Entry {
    const ViewedField* view;
    std::weak_ptr<ViewedField> alive; // expires as soon as the view's destruction begins
  };
  std::mutex mutex;
  std::unordered_map<const void*, Entry> byStorage;
  std::atomic<size_t> size{0}; // read at every change of a list; most programs have no views
};
Table& table() {
  static Table& all = *new Table(); // never destroyed: views may outlive static objects
  return all;
}

// Calls f with the list if the field's type is a list of numbers. Returns whether it is.
template <class F> bool withNumbers(FieldType type, void* storage, const F& f) {
  return visitStorage(type, storage, [&](auto& value) {
    constexpr bool is = isNumberList<std::remove_reference_t<decltype(value)>>;
    if constexpr (is) f(value);
    return is;
  });
}

} // namespace

ViewedField::ViewedField(Node& node, const FieldInfo& field) : storage_(node.storage(field)) {
  withNumbers(field.type, node.storage(field), [this](const auto& list) {
    data_ = list.data();
    size_ = list.size();
  });
}

ViewedField::~ViewedField() {
  Table& all = table();
  const std::scoped_lock lock(all.mutex);
  const auto found = all.byStorage.find(storage_);
  if (found == all.byStorage.end() || found->second.view != this) return;
  all.byStorage.erase(found);
  all.size = all.byStorage.size();
}

std::shared_ptr<const ViewedField> viewField(Node& node, const FieldInfo& field) {
  if (!holdsValue(field) || !withNumbers(field.type, node.storage(field), [](const auto&) {}))
    return nullptr;
  Table& all = table();
  std::shared_ptr<ViewedField> made; // destroyed after the lock is released
  const std::scoped_lock lock(all.mutex);
  auto& entry = all.byStorage[node.storage(field)];
  if (auto known = entry.alive.lock()) return known;
  made = std::make_shared<ViewedField>(node, field);
  entry = {made.get(), made};
  all.size = all.byStorage.size();
  return made;
}

void leaveToViews(Node& node, const FieldInfo& field) {
  Table& all = table();
  if (all.size.load(std::memory_order_relaxed) == 0) return;
  std::shared_ptr<ViewedField> view; // destroyed after the lock is released
  const std::scoped_lock lock(all.mutex);
  const auto found = all.byStorage.find(node.storage(field));
  if (found == all.byStorage.end()) return;
  view = found->second.alive.lock();
  all.byStorage.erase(found);
  all.size = all.byStorage.size();
  // Moving a vector keeps its elements at their addresses.
  if (view)
    withNumbers(field.type, node.storage(field),
                [&](auto& list) { view->kept_ = std::move(list); });
}

} // namespace xvrml
