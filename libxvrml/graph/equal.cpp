// equal.cpp: compares two graphs. Nodes are matched one to one in the order of the traversal, so
// that sharing must be equal, too. Bodies of prototype instances follow from their declarations and
// are not compared. [the thread that owns both]
#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "enough_stack.h"
#include "graph/field_access.h"
#include "xvrml/node_map.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// Returns whether two values that are not equal have the same numbers: files may hold not-a-number,
// which differs from itself.
template <class T> bool areSameNumbers(const T& a, const T& b) {
  if constexpr (Numeric<T>) {
    for (int i = 0; i < numberCount<T>; ++i) {
      const auto x = numbersOf(a)[i], y = numbersOf(b)[i];
      if (x != y && (x == x || y == y)) return false;
    }
    return true;
  } else if constexpr (isNumberList<T>) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return areSameNumbers(x, y); });
  } else {
    return false;
  }
}

class Comparison {
 public:
  std::string difference;

  bool scopes(const Scope& a, const Scope& b) {
    if (a.prototypes.size() != b.prototypes.size())
      return fail("number of prototypes", a.prototypes.size(), b.prototypes.size());
    for (size_t i = 0; i < a.prototypes.size(); ++i) {
      if (!prototypes(*a.prototypes[i], *b.prototypes[i]))
        return at("PROTO " + a.prototypes[i]->type->name);
    }
    if (!nodeLists(a.roots, b.roots)) return at("roots");
    return routes(a.routes, b.routes) && names(a, b);
  }

 private:
  bool fail(std::string what) {
    difference = std::move(what);
    return false;
  }
  template <class T> bool fail(std::string_view what, const T& a, const T& b) {
    return fail(fmt::format("{}: {} and {}", what, a, b));
  }
  bool at(std::string_view where) {
    if (difference.size() < 2000) difference = fmt::format("{} / {}", where, difference);
    return false;
  }

  bool prototypes(const ProtoDeclaration& a, const ProtoDeclaration& b) {
    if (a.isExtern != b.isExtern) return fail("PROTO and EXTERNPROTO");
    if (a.urls != b.urls) return fail("URLs");
    return types(*a.type, *b.type, true) && scopes(a.body, b.body) && connections(a.is, b.is);
  }

  bool types(const NodeType& a, const NodeType& b, bool defaults) {
    if (a.name != b.name) return fail("type", a.name, b.name);
    if (a.fields.size() != b.fields.size())
      return fail("number of fields", a.fields.size(), b.fields.size());
    for (size_t i = 0; i < a.fields.size(); ++i) {
      const FieldInfo &x = a.fields[i], &y = b.fields[i];
      if (x.name != y.name || x.type != y.type || x.access != y.access)
        return fail("field", x.name, y.name);
      if (!defaults || !holdsValue(x)) continue;
      const bool same = std::visit(
          [&](const auto& value) {
            return values(value, std::get<std::remove_cvref_t<decltype(value)>>(y.defaultValue));
          },
          x.defaultValue);
      if (!same) return at(x.name);
    }
    return true;
  }

  bool nodes(const NodeRef& a, const NodeRef& b) {
    if (!a || !b) return (!a && !b) || fail("a node and NULL");
    const auto [first, newA] = matchA_.insert(a.get(), {b.get(), matchA_.size()});
    const auto [second, newB] = matchB_.insert(b.get(), a.get());
    if (first->node != b.get() || *second != a.get()) return fail("nodes are shared otherwise");
    if (!newA && !newB) return true;
    if (a->defName != b->defName) return fail("DEF", a->defName, b->defName);
    if (&a->type() != &b->type() && !types(a->type(), b->type(), false)) return false;
    for (size_t i = 0; i < a->type().fields.size(); ++i) {
      const FieldInfo &x = a->type().fields[i], &y = b->type().fields[i];
      if (!holdsValue(x)) continue;
      const Node &one = *a, &other = *b; // only read
      const bool same = visitStorage(x.type, one.storage(x), [&](const auto& value) {
        using T = std::remove_cvref_t<decltype(value)>;
        return values(value, *static_cast<const T*>(other.storage(y)));
      });
      if (!same) return at(fmt::format("{} {}.{}", a->defName, a->type().name, x.name));
    }
    return true;
  }

  bool nodeLists(const MFNode& a, const MFNode& b) {
    if (a.size() != b.size()) return fail("number of nodes", a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      if (!nodes(a[i], b[i])) return at(fmt::format("{}", i));
    }
    return true;
  }

  bool values(const NodeRef& a, const NodeRef& b) { return nodes(a, b); }
  bool values(const MFNode& a, const MFNode& b) { return nodeLists(a, b); }
  template <class T> bool values(const T& a, const T& b) {
    return a == b || areSameNumbers(a, b) || fail("values differ");
  }

  // The order of routes and connections has no meaning, so they are compared sorted by node number.
  size_t number(const NodeRef& a) const {
    const Match* const found = matchA_.find(a.get());
    return found ? found->number : ~size_t(0);
  }
  NodeRef partner(const NodeRef& b) const {
    Node* const* const found = matchB_.find(b.get());
    return found ? NodeRef(*found) : NodeRef();
  }

  bool routes(const std::vector<Route>& a, const std::vector<Route>& b) {
    using Key = std::tuple<size_t, std::string, size_t, std::string>;
    std::vector<Key> left, right;
    for (const Route& r : a)
      left.emplace_back(number(r.from), r.fromField, number(r.to), r.toField);
    for (const Route& r : b)
      right.emplace_back(number(partner(r.from)), r.fromField, number(partner(r.to)), r.toField);
    std::sort(left.begin(), left.end());
    std::sort(right.begin(), right.end());
    return left == right || fail("routes", left.size(), right.size());
  }

  bool connections(const std::vector<IsConnection>& a, const std::vector<IsConnection>& b) {
    using Key = std::tuple<size_t, std::string, std::string>;
    std::vector<Key> left, right;
    for (const IsConnection& c : a) left.emplace_back(number(c.node), c.field, c.interfaceName);
    for (const IsConnection& c : b)
      right.emplace_back(number(partner(c.node)), c.field, c.interfaceName);
    std::sort(left.begin(), left.end());
    std::sort(right.begin(), right.end());
    return left == right || fail("IS", left.size(), right.size());
  }

  bool names(const Scope& a, const Scope& b) {
    if (a.names.size() != b.names.size())
      return fail("number of names", a.names.size(), b.names.size());
    for (const auto& [name, node] : a.names) {
      const auto other = b.names.find(name);
      if (other == b.names.end()) return fail("name", name, std::string("none"));
      if (number(node) != number(partner(other->second)))
        return fail(fmt::format("name {} means another node", name));
    }
    return true;
  }

  struct Match {
    const Node* node = nullptr;
    size_t number = 0; // in the order of the traversal
  };
  NodeMap<Match> matchA_; // by the nodes of the first graph
  NodeMap<Node*> matchB_; // by those of the second one
};

} // namespace

bool equalScopes(const Scope& a, const Scope& b, std::string* difference) {
  constexpr size_t deepestStack = size_t(6) << 20; // bytes; recursion follows the nodes
  return onStackOf(deepestStack, [&] {
    Comparison comparison;
    const bool equal = comparison.scopes(a, b);
    if (difference) *difference = std::move(comparison.difference);
    return equal;
  });
}

} // namespace xvrml
