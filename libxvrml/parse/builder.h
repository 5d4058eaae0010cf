// builder.h: builds the scene graph from the parser's calls: nodes, names, prototypes, routes. It
// makes all checks that depend on node types. One builder per file, on the thread that loads.
#pragma once

#include <deque>
#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "graph/load_state.h"
#include "parse/sink.h"

namespace xvrml {

// Wide because there is one function for each event of the sink, and one for each thing that a file
// may state wrongly.
class Builder : public ParseSink {
 public:
  Builder(Locator& locator, LoadState& state, ParsedFile& file);
  void finish(); // called at the end of the file
  // Return the innermost node that is open, and its field that is. There must be one.
  const Node& innermostNode() const { return *nodes_.back().node; }
  const FieldInfo& innermostField() const { return *nodes_.back().field; }
  // Returns the node that a USE of this name refers to here; null if there is none.
  const Node* named(std::string_view name) const;
  bool openNode(const Name& type, const Name* def) override;
  void closeNode(bool good) override;
  SourcePosition openNodePlace() const override;
  const NodeType* typeNamed(std::string_view name) const override;
  size_t nodeTarget() const override { return nodeTargets_.size(); }
  bool wouldAccept(size_t nodeTarget, std::string_view name, bool use) const override;
  bool declaresFields() const override;
  void useNode(const Name& name) override;
  void nullNode(const Name& token) override;
  void lostName(const Name& name) override;
  FieldTarget openField(const Name& name) override;
  FieldTarget resumeField(const Name& name) override;
  bool hasField(std::string_view name) const override;
  std::string_view fieldFor(std::string_view name, bool use) const override;
  void closeField(bool good) override;
  void connect(const Name& field, const Name& interfaceName) override;
  FieldTarget openDeclaration(Access access, FieldType type, const Name& name,
                              bool hasValue) override;
  void closeDeclaration(bool good) override;
  void openProto(const Name& name) override;
  void openProtoBody() override;
  void closeProto(bool good) override;
  void openExternProto(const Name& name) override;
  std::vector<std::string>& externUrls() override;
  void closeExternProto(bool good) override;
  void route(const Name& keyword, const RouteNames& names) override;
  void version(int major, int minor) override;
  void profile(const Name& name) override;
  void component(const Name& name, int32_t level) override;
  void meta(const Name& keyword, std::string name, std::string content) override;
  void unit(const Name& category, const Name& name, double factor) override;
  void importNode(const Name& keyword, const ImportNames& names) override;
  void exportNode(const Name& node, const Name& exported) override;

 private:
  // Sizes of the lists that grow while a node is read. rollBack() restores them if the node is
  // lost.
  struct Mark {
    size_t instances, inlines, names, routes, connections;
  };
  struct NodeFrame {
    NodeRef node;
    Name type;
    // The node's own type, which grows while it is read; null: it has none (yet).
    std::shared_ptr<NodeType> ownType;
    Mark mark;
    // Number of nodes in the open node, shared ones counted at each use.
    uint64_t expanded = 1;
    size_t firstGiven = 0;            // its fields in given_
    const FieldInfo* field = nullptr; // the field that is being read
    const char* fieldAt = nullptr;
    bool declares = false; // the node may declare fields
  };
  // The place to which the next complete node is added.
  struct NodeTarget {
    enum class Kind : uint8_t { roots, single, multiple } kind;
    void* storage;
    const FieldInfo* field; // null: not a field of a node type
    Node* holder;           // the node that has the field
    const char* at;
  };
  struct Declaration {
    FieldInfo field;
    const char* at;
    bool accepted; // no other declaration has the same names
    bool scoped;   // a prototype's default made of nodes, which have a scope of their own
    bool hasValue;
  };
  struct ScopeFrame {
    Scope* scope;
    ProtoPtr proto;                      // null: the file, or a default value
    std::shared_ptr<NodeType> protoType; // interface of the open prototype, which is still growing
    std::unique_ptr<Scope> own;          // the scope of a default value
    std::unordered_map<std::string_view, ProtoPtr> types;
    std::unordered_set<std::string_view> lost, lostTold;
    std::vector<std::string_view> defined;
    // Names of nodes to which a USE or ROUTE has given a place.
    std::unordered_set<std::string_view> placed;
    // For each node in a wrong place: the names within it, and their nodes.
    std::vector<std::vector<std::pair<std::string_view, NodeRef>>> misplaced;
    std::unordered_map<const Node*, NodeRef> earlier; // former owner of a node's name
    uint64_t expanded = 0;
    size_t outerNodes = 0; // number of nodes that were open when the scope began
  };

  Mark mark() const;
  void rollBack(const Mark& mark);
  void keepNames(const Mark& mark);
  ScopeFrame& scope() { return scopes_.back(); }
  ScopeFrame* protoFrame();
  bool inTemplate() const { return scopes_.size() > 1; }
  void pushScope(Scope* scope, ProtoPtr proto, std::shared_ptr<NodeType> type);
  void popScope();
  void dropUnplacedNames();
  Exchange& exchange();
  bool isImported(std::string_view name) const;
  bool isAngle(const Node& node, const FieldInfo& field) const;
  void convertAngles(FieldType type, void* storage) const;
  bool importedRoute(const Name& keyword, const RouteNames& names);
  bool reserveMemory(uint64_t bytes, const Name& at);
  bool makeNode(const Name& type, NodeFrame& frame);
  void checkChild(const NodeFrame& frame);
  bool deliver(const Name& at, const NodeRef& node, uint64_t expanded);
  bool place(const Name& at, const NodeRef& node, uint64_t expanded);
  std::string_view acceptedTypes(const NodeTarget& nodeTarget) const;
  bool acceptsType(const NodeTarget& nodeTarget, const NodeType* type) const;
  bool accepts(const NodeTarget& nodeTarget, const Name& at, const Node& node,
               std::string_view remedy);
  bool isX3d() const { return file_.head.version.isX3d(); }
  bool isVrml97() const { return file_.head.version.encoding == Encoding::vrml97; }
  std::string_view spelled(const NodeType& type, std::string_view name) const;
  const FieldInfo* eventIn(const NodeType& type, std::string_view own) const;
  const FieldInfo* eventOut(const NodeType& type, std::string_view own) const;
  std::string_view word(Access access) const;
  bool isFirst(const std::string& name) { return reported_.insert(name).second; }
  bool lacksField(const NodeType& type, std::string_view name) const;
  bool isGiven(const Name& name) const;
  FieldTarget targetOf(const FieldInfo& field, bool resumed);
  const NodeType* typeOf(std::string_view name, bool use) const;
  bool isMissingField(const NodeType& type, const Name& name);
  void reportGpuProgram(const Name& name);
  void reportUnknownNode(const Name& type);
  void noteGlobe(const NodeFrame& frame);
  void warnOfLack(const NodeType& type, const Name& at);
  void warnOfX3d(const NodeType& type, const Name& at);
  void warnOfX3d(const NodeType& type, const FieldInfo& field, const Name& at);
  uint64_t expandedCount(const Node* node) const;
  ProtoPtr findPrototype(std::string_view name) const;
  bool isBeingDeclared(std::string_view name) const;
  bool isLost(std::string_view name) const;
  bool declarationConflicts(const NodeType& type, const FieldInfo& field, const Name& name);
  NodeType& declaringType();
  bool mayDeclare(const NodeType& type, Access access, const Name& name);
  NodeRef findName(const Name& name);
  bool isOpen(const Node* node) const;

  Locator& locator_;
  LoadState& state_;
  ParsedFile& file_;
  std::deque<ScopeFrame> scopes_; // deques do not move their elements
  std::deque<Declaration> declarations_;
  std::vector<NodeFrame> nodes_;
  std::vector<std::string_view> given_; // fields read so far, of the open nodes one after the other
  std::vector<NodeTarget> nodeTargets_;
  std::unordered_map<const Node*, uint64_t> expanded_; // counts of more than 1 of named nodes
  std::unordered_set<std::string> reported_;           // nodes and fields of X3D that were reported
  std::unordered_map<std::string_view, size_t> imports_; // numbers in Exchange::imports
  std::vector<std::pair<Name, Name>> exports_;           // nodes, and the names they are given
  double angle_ = 1;                                     // radians in the file's unit of angles
  const NodeType* fullInterface_ = nullptr; // the last type that declares more than the limit
};

} // namespace xvrml
