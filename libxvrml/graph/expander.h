// expander.h: expands prototype instances: each gets a copy of the prototype's body (ISO/IEC
// 14772-1 4.8.3). The loader calls it when a file has been parsed. The cost of an instance is added
// up before anything is made.
#pragma once

#include <functional>
#include <unordered_map>

#include "graph/load_state.h"

namespace xvrml {

class Expander {
 public:
  // Finds the declaration that an EXTERNPROTO refers to. Returns null, with a message, if there is
  // none.
  using Resolve = std::function<ProtoPtr(ProtoDeclaration&)>;
  Expander(LoadState& state, Resolve resolve) : state_(state), resolve_(std::move(resolve)) {}

  // Expands the instances and the instances within them. Appends the Inline nodes of the copies to
  // `inlines`.
  void expand(const std::vector<NodeRef>& instances, std::vector<NodeRef>& inlines);

 private:
  // Data that all copies of a body share, computed once per prototype.
  struct Plan {
    ProtoPtr declaration;
    std::vector<Node*> nodes; // nodes of the body and what they hold, each once
    std::unordered_map<const Node*, uint32_t> index;
    std::vector<bool> shared;              // nodes that nothing can change: all copies share them
    uint64_t expandedNodes = 0, bytes = 0; // including all nested prototypes; saturating
    uint64_t ownBytes = 0;                 // bytes of the nodes that are copied for each instance
    bool usable = false, computing = false;
  };
  using PlanPtr = std::shared_ptr<Plan>;

  ProtoPtr definition(ProtoInstance& instance);
  PlanPtr plan(const ProtoPtr& declaration, const SourcePosition& where);
  bool addNested(Plan& plan, ProtoInstance& nested, const SourcePosition& where);
  bool addDefaults(Plan& plan, const SourcePosition& where);
  void markShared(Plan& plan, const ProtoDeclaration& declaration) const;
  void expandOne(ProtoInstance& instance, std::vector<NodeRef>& inlines);
  void completeFields(ProtoInstance& instance, const ProtoDeclaration& definition,
                      std::vector<NodeRef>& inlines);
  // Records a Script or instance whose fields may hold a node that it is part of.
  void addCyclic(const NodeRef& node);
  NodeRef copyNode(Node& original);
  void copyFields(const Node& original, Node& copy,
                  const std::unordered_map<const Node*, uint32_t>& index,
                  const std::vector<NodeRef>& copies);
  std::vector<NodeRef> copyAll(const std::vector<Node*>& nodes,
                               const std::unordered_map<const Node*, uint32_t>& index,
                               const std::vector<bool>& shared, std::vector<NodeRef>& inlines);
  Value copyDefault(const FieldInfo& declared, std::vector<NodeRef>& inlines);
  void applyConnections(ProtoInstance& instance, const ProtoDeclaration& definition,
                        std::vector<NodeRef>& inlines);
  void connect(const ProtoInstance& instance, const FieldInfo& from, const Value& value,
               const IsConnection& connection, const std::shared_ptr<const std::string>& base);
  void findUrlFields(ProtoDeclaration& declaration);

  LoadState& state_;
  Resolve resolve_;
  const FieldInfo* fieldOf(const NodeType& type, std::string_view name);

  std::unordered_map<const ProtoDeclaration*, PlanPtr> plans_;
  // Numbers of the fields of large types by name. A type may end and another begin in its place:
  // what is found is checked.
  std::unordered_map<const NodeType*, std::unordered_map<std::string, uint32_t>> fieldsByName_;
  std::vector<NodeRef> todo_;
  uint64_t depth_ = 0;
};

// Appends every node that the roots hold in their fields, each once, the roots first. Not
// recursive, because graphs may be deep.
void collectNodes(const std::vector<Node*>& roots, std::vector<Node*>& nodes,
                  std::unordered_map<const Node*, uint32_t>& index);
// Returns the estimated size of a node in memory, with the values of its fields.
uint64_t nodeBytes(const Node& node);
// Returns the estimated size of a field's value outside of its node: elements of lists, long
// strings, pixels.
uint64_t valueBytes(FieldType type, const void* storage);

} // namespace xvrml
