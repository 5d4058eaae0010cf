// expander.h: prototype instances get their copy of the prototype's body (ISO/IEC 14772-1 4.8.3). Used by the loader once a file
// has been parsed; what an instance would cost is added up before anything is made.
#pragma once

#include <functional>
#include <unordered_map>

#include "parse/load_state.h"

namespace xvrml {

class Expander {
 public:
  // resolve finds the declaration behind an EXTERNPROTO (null, with a message, if it cannot be found).
  using Resolve = std::function<ProtoPtr(ProtoDeclaration&)>;
  Expander(LoadState& state, Resolve resolve) : state_(state), resolve_(std::move(resolve)) {}

  // Expands the instances and those within them; appends the Inline nodes of the copies to inlines.
  void expand(const std::vector<NodeRef>& instances, std::vector<NodeRef>& inlines);

 private:
  // What every copy of a body needs to know, found once.
  struct Plan {
    ProtoPtr declaration;
    std::vector<Node*> nodes; // of the body and what it holds, each once
    std::unordered_map<const Node*, uint32_t> index;
    std::vector<bool> shared;              // nothing can ever change it: one for all copies
    uint64_t expandedNodes = 0, bytes = 0; // with all prototypes within; saturating
    uint64_t ownBytes = 0;                 // of the nodes copied for each instance
    bool usable = false, computing = false;
  };
  using PlanPtr = std::shared_ptr<Plan>;

  ProtoPtr definition(ProtoInstance& instance);
  PlanPtr plan(const ProtoPtr& declaration, const SourcePosition& where);
  bool addNested(Plan& plan, ProtoInstance& nested, const SourcePosition& where);
  bool addDefaults(Plan& plan, const SourcePosition& where);
  void markShared(Plan& plan, const ProtoDeclaration& declaration) const;
  void expandOne(ProtoInstance& instance, std::vector<NodeRef>& inlines);
  void completeFields(ProtoInstance& instance, const ProtoDeclaration& definition, std::vector<NodeRef>& inlines);
  void holdsItself(const NodeRef& node); // a Script or instance whose fields may hold what it is part of
  NodeRef copyNode(Node& original);
  void copyFields(const Node& original, Node& copy, const std::unordered_map<const Node*, uint32_t>& index,
                  const std::vector<NodeRef>& copies);
  std::vector<NodeRef> copyAll(const std::vector<Node*>& nodes, const std::unordered_map<const Node*, uint32_t>& index,
                               const std::vector<bool>& shared, std::vector<NodeRef>& inlines);
  Value copyDefault(const FieldInfo& declared, std::vector<NodeRef>& inlines);
  void applyConnections(ProtoInstance& instance, const ProtoDeclaration& definition, std::vector<NodeRef>& inlines);
  void connect(const ProtoInstance& instance, const FieldInfo& from, const Value& value, const IsConnection& connection);

  LoadState& state_;
  Resolve resolve_;
  const FieldInfo* fieldOf(const NodeType& type, std::string_view name);

  std::unordered_map<const ProtoDeclaration*, PlanPtr> plans_;
  // Numbers of the fields of large types by name. A type may end and another begin in its place: what is found is checked.
  std::unordered_map<const NodeType*, std::unordered_map<std::string, uint32_t>> fieldsByName_;
  std::vector<NodeRef> todo_;
  uint64_t depth_ = 0;
};

// Every node that the given ones hold in their fields, themselves first, each once. A loop: graphs may be deep.
void collectNodes(const std::vector<Node*>& roots, std::vector<Node*>& nodes, std::unordered_map<const Node*, uint32_t>& index);
// Rough size of a node in memory, with the values of its fields.
uint64_t nodeBytes(Node& node);
// Rough size of a field's value beyond the storage in its node: elements of lists, long strings, pixels.
uint64_t valueBytes(FieldType type, const void* storage);

} // namespace xvrml
