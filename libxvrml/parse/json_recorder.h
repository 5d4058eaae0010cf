// json_recorder.h: records where everything stands in a text of X3D in JSON. The reader says which
// object it is in. [the thread that loads]
#pragma once

#include <vector>

#include "parse/json_index.h"
#include "parse/layout_recorder.h"

namespace xvrml {

class JsonRecorder : public LayoutRecorder {
 public:
  static constexpr size_t none = ~size_t(0);
  // An object that stands for an element, as numbers of values in the index.
  struct Element {
    size_t object;
    size_t holder; // the object whose only member it is: {"Shape": { }}; none: it is in no such one
    size_t list;   // the member that holds the node: "-children"; none for the node of a fragment
  };

  JsonRecorder(Builder& builder, Locator& locator, TextLayout& layout, const JsonIndex& index)
      : LayoutRecorder(builder, locator, layout), index_(index) {}

  // The reader calls these around each element.
  void enter(const Element& element);
  void leave() { open_.pop_back(); }

  void useNode(const Name& name) override;
  FieldTarget openField(const Name& name) override;
  FieldTarget resumeField(const Name& name) override;
  void route(const Name& keyword, const RouteNames& names) override;
  // Says what of the text cannot be edited, once all has been read. isFragment: it has no Scene.
  void finish(bool isFragment);

 private:
  using Value = JsonIndex::Value;

  NodeText begunNode(const Name& type, const Name* def) override;
  void endNode(NodeText& node) override;
  size_t prototypeBegin(const Name&, std::string_view) const override {
    return spanOfHolder().begin;
  }
  size_t prototypeEnd() const override { return spanOfHolder().end; }

  const Value& at(size_t index) const { return index_.values()[index]; }
  const Element& element() const { return open_.back(); }
  size_t offset(const char* at) const { return size_t(at - locator_.text().data()); }
  TextSpan spanOf(const Value& value) const {
    return {offset(value.text.data()), offset(value.text.data()) + value.text.size()};
  }
  TextSpan memberSpan(const Value& value) const {
    return {offset(value.key.data()) - 1, spanOf(value).end};
  }
  TextSpan bodyOf(const Value& object) const {
    return {spanOf(object).begin + 1, spanOf(object).end};
  }
  TextSpan nameAt(const char* value) const;
  TextSpan spanOfHolder() const;
  bool isOwnMember();
  FieldText begunElement(std::string name) const;
  FieldText begunDeclaration(const Name& name) const override {
    return begunElement(std::string(name.text));
  }
  void addEmptyLists(NodeText& node);
  void refuse(std::string_view reason) const;

  const JsonIndex& index_;
  std::vector<Element> open_;
};

} // namespace xvrml
