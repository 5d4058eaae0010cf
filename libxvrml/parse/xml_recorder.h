// xml_recorder.h: records where everything stands in a text of X3D in XML. The innermost element of
// the index is the one whose tag the reader has just read. [the thread that loads]
#pragma once

#include "parse/layout_recorder.h"

namespace xvrml {

class XmlRecorder : public LayoutRecorder {
 public:
  using LayoutRecorder::LayoutRecorder;

  void useNode(const Name& name) override;
  FieldTarget openField(const Name& name) override;
  FieldTarget resumeField(const Name& name) override;
  void route(const Name& keyword, const RouteNames& names) override;
  // Notes the ends of elements, once all have been read.
  void finish();

 private:
  NodeText begunNode(const Name& type, const Name* def) override;
  void endNode(NodeText&) override {}
  size_t prototypeBegin(const Name&, std::string_view) const override { return element().begin; }
  size_t prototypeEnd() const override { return 0; }

  const XmlElement& element() const { return layout_.xml.innermost(); }
  FieldText begunElement(std::string name) const;
  FieldText begunDeclaration(const Name& name) const override {
    return begunElement(std::string(name.text));
  }
  TextSpan valueOf(std::string_view attribute) const;
  void complete(TextSpan& span) const { span.end = layout_.xml.at(span.begin).end; }
};

} // namespace xvrml
