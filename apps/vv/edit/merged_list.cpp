#include "edit/merged_list.h"

#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "xvrml/edit.h"
#include "xvrml/numbers.h"

namespace vv {

using namespace xvrml;

void noteTouched(const Value& shown, const Value& wanted, std::vector<bool>& touched) {
  std::visit(
      [&](const auto& list) {
        using T = std::remove_cvref_t<decltype(list)>;
        if constexpr (isList<T>) {
          const T* const before = std::get_if<T>(&shown);
          if (!before || before->size() != list.size()) return;
          touched.resize(list.size());
          for (size_t i = 0; i < list.size(); ++i)
            touched[i] = touched[i] || list[i] != (*before)[i];
        }
      },
      wanted);
}

Value mergedList(const ChangedList& change, const Value& now, bool isOwn, const std::string& what) {
  Value wanted = change.wanted;
  std::visit(
      [&](auto& list) {
        using T = std::remove_cvref_t<decltype(list)>;
        if constexpr (isList<T>) {
          const T *const before = std::get_if<T>(&change.shown), *const present =
                                                                     std::get_if<T>(&now);
          if (!before || !present || *before == *present) return;
          if (before->size() != list.size() || present->size() != list.size()) {
            if (isOwn) return;
            throw EditError(fmt::format("{} has changed meanwhile: its value stays", what));
          }
          for (size_t i = 0; i < list.size(); ++i)
            if (i >= change.touched.size() || !change.touched[i]) list[i] = (*present)[i];
        }
      },
      wanted);
  return wanted;
}

} // namespace vv
