// layout_recorder.h: sinks between a reader and the builder: they pass everything on, and note
// meanwhile where it stands in the text. Worlds that nobody edits are read without them.
// [the thread that loads]
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "parse/builder.h"
#include "parse/text_layout.h"

namespace xvrml {

// The common part of the recorders of all syntaxes. Wide because there is one function for each
// event of the sink.
class LayoutRecorder : public ParseSink {
 public:
  LayoutRecorder(Builder& builder, Locator& locator, TextLayout& layout)
      : builder_(builder), locator_(locator), layout_(layout) {}

  bool openNode(const Name& type, const Name* def) override;
  void closeNode(bool good) override;
  void closeField(bool good) override;
  FieldTarget openDeclaration(Access access, FieldType type, const Name& name,
                              bool hasValue) override;
  void closeDeclaration(bool good) override;
  void openProto(const Name& name) override;
  void closeProto(bool good) override;
  void openExternProto(const Name& name) override;
  void closeExternProto(bool good) override;

  SourcePosition openNodePlace() const override { return builder_.openNodePlace(); }
  const NodeType* typeNamed(std::string_view name) const override {
    return builder_.typeNamed(name);
  }
  size_t nodeTarget() const override { return builder_.nodeTarget(); }
  bool wouldAccept(size_t nodeTarget, std::string_view name, bool use) const override {
    return builder_.wouldAccept(nodeTarget, name, use);
  }
  bool declaresFields() const override { return builder_.declaresFields(); }
  void nullNode(const Name& token) override { builder_.nullNode(token); }
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

 protected:
  struct OpenNode {
    const Node* node;
    NodeText text;
    size_t firstField; // in fields_
    bool inField = false;
    FieldText field;
  };
  bool isRecording() const { return prototypes_ == 0; }
  OpenNode& innermost() { return nodes_.back(); }
  void beginField(FieldText field);
  // Forgets fields of the innermost node.
  template <class Predicate> void forgetFields(Predicate isForgotten) {
    const auto begin = fields_.begin() + std::ptrdiff_t(innermost().firstField);
    fields_.erase(std::remove_if(begin, fields_.end(), isForgotten), fields_.end());
  }
  void add(const NodePlace& place);
  void addRoute(const Name& keyword, RouteText route);

  // Returns where a node begins that is being opened, and where its name stands.
  virtual NodeText begunNode(const Name& type, const Name* def) = 0;
  // Notes where a node ends that is being closed.
  virtual void endNode(NodeText& node) = 0;
  // Returns where a field begins that a node declares, with a value.
  virtual FieldText begunDeclaration(const Name& name) const = 0;
  // Notes where the open field ends. good: its value could be read. In syntaxes with elements the
  // end follows from the beginning; programs of Scripts, and values that could not be read, are
  // left as they are.
  virtual void endField(FieldText& field, bool good);
  // Returns where a prototype begins whose keyword is given.
  virtual size_t prototypeBegin(const Name& name, std::string_view keyword) const = 0;
  // Returns where the prototype ends that is being closed.
  virtual size_t prototypeEnd() const = 0;

  Builder& builder_;
  Locator& locator_;
  TextLayout& layout_;

 private:
  void finishField(bool good);
  void beginPrototype(const Name& name, std::string_view keyword);
  void endPrototype(bool good);

  std::vector<OpenNode> nodes_;
  std::vector<FieldText> fields_; // those of all open nodes, the innermost last
  size_t prototypes_ = 0;         // number of prototypes that are open
};

} // namespace xvrml
