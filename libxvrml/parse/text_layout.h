// text_layout.h: where the nodes, fields and routes of a world stand in its text, for programs that
// change a part of the text and leave the rest. Prototypes are left out: nothing within them is
// changed. [the thread that loads]
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "parse/builder.h"

namespace xvrml {

// Returns a key for a place in a file.
inline uint64_t placeKey(uint32_t line, uint32_t column) { return uint64_t(line) << 32 | column; }

// A part of a text, in bytes from its beginning.
struct TextSpan {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
};

// A node, a USE or NULL at one place in a list of nodes, or as the value of an SFNode.
struct NodePlace {
  TextSpan span;
  const Node* node = nullptr; // null: NULL
  bool isUse = false;         // the node itself stands further up
};

struct FieldText {
  std::string name; // as the node's type has it
  TextSpan whole;   // from its name to the end of its value
  TextSpan value;
  std::vector<NodePlace> nodes; // what stands in the value of an SFNode or MFNode
  bool declared = false;        // the node declares the field: it has a value in any case
  bool readable = false;        // the whole value could be read
  bool faithful = false;        // the world has taken all of it
};

struct NodeText {
  NodeRef node;   // keeps a node that the world has not taken, because places refer to it
  TextSpan whole; // from DEF, or from the type, to the closing brace
  TextSpan name;  // the name behind DEF; empty if there is none
  TextSpan body;  // from behind the opening brace to behind the closing one
  std::vector<FieldText> fields; // in the order of the text
};

struct RouteText {
  TextSpan whole;
  TextSpan from, to; // the names of the nodes
  uint32_t line = 0, column = 0;
  bool valid = false; // the world has the route
};

// A PROTO or EXTERNPROTO outside of other prototypes.
struct PrototypeText {
  TextSpan whole;
  uint32_t line = 0, column = 0; // where its name stands
};

struct TextLayout {
  std::unordered_map<const Node*, NodeText> nodes;
  std::vector<NodePlace> roots;
  std::vector<RouteText> routes;
  std::vector<PrototypeText> prototypes;
};

// Passes everything on to a builder, and fills the layout meanwhile. Wide because there is one
// function for each event of the sink.
class LayoutRecorder : public ParseSink {
 public:
  LayoutRecorder(Builder& builder, Locator& locator, TextLayout& layout)
      : builder_(builder), locator_(locator), layout_(layout) {}

  void placed(const char* begin, const char* end) override;
  bool openNode(const Name& type, const Name* def) override;
  void closeNode(bool good) override;
  void useNode(const Name& name) override;
  void nullNode(const Name& token) override;
  FieldTarget openField(const Name& name) override;
  void closeField(bool good) override;
  FieldTarget openDeclaration(Access access, FieldType type, const Name& name,
                              bool hasValue) override;
  void closeDeclaration(bool good) override;
  void openProto(const Name& name) override;
  void closeProto(bool good) override;
  void openExternProto(const Name& name) override;
  void closeExternProto(bool good) override;
  void route(const Name& keyword, const RouteNames& names) override;

  SourcePosition openNodePlace() const override { return builder_.openNodePlace(); }
  const NodeType* typeNamed(std::string_view name) const override {
    return builder_.typeNamed(name);
  }
  size_t nodeTarget() const override { return builder_.nodeTarget(); }
  bool wouldAccept(size_t nodeTarget, std::string_view name, bool use) const override {
    return builder_.wouldAccept(nodeTarget, name, use);
  }
  bool declaresFields() const override { return builder_.declaresFields(); }
  void lostName(const Name& name) override { builder_.lostName(name); }
  FieldTarget resumeField(const Name& name) override { return builder_.resumeField(name); }
  bool hasField(std::string_view name) const override { return builder_.hasField(name); }
  std::string_view fieldFor(std::string_view name, bool use) const override {
    return builder_.fieldFor(name, use);
  }
  void connect(const Name& field, const Name& interfaceName) override {
    builder_.connect(field, interfaceName);
  }
  void openProtoBody() override { builder_.openProtoBody(); }
  std::vector<std::string>& externUrls() override { return builder_.externUrls(); }
  void version(int major, int minor) override { builder_.version(major, minor); }
  void profile(const Name& name) override { builder_.profile(name); }
  void component(const Name& name, int32_t level) override { builder_.component(name, level); }
  void meta(const Name& keyword, std::string name, std::string content) override {
    builder_.meta(keyword, std::move(name), std::move(content));
  }
  void unit(const Name& category, const Name& name, double factor) override {
    builder_.unit(category, name, factor);
  }
  void importNode(const Name& keyword, const ImportNames& names) override {
    builder_.importNode(keyword, names);
  }
  void exportNode(const Name& node, const Name& exported) override {
    builder_.exportNode(node, exported);
  }

 private:
  struct OpenNode {
    const Node* node;
    NodeText text;
    bool inField = false;
    FieldText field;
  };
  bool isRecording() const { return prototypes_ == 0; }
  size_t offset(const char* at) const { return size_t(at - locator_.text().data()); }
  TextSpan spanOf(const Name& name) const {
    return {offset(name.at), offset(name.at) + name.text.size()};
  }
  size_t keywordBefore(const Name& name, std::string_view keyword) const;
  void beginField(std::string name, const char* at);
  void endField(bool good);
  void add(const NodePlace& place);
  void beginPrototype(const Name& name, std::string_view keyword);
  void endPrototype(bool good);

  Builder& builder_;
  Locator& locator_;
  TextLayout& layout_;
  std::vector<OpenNode> nodes_;
  TextSpan placed_;
  size_t prototypes_ = 0; // number of prototypes that are open
};

} // namespace xvrml
