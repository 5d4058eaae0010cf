// classic_recorder.h: records where everything stands in a text of VRML97 or X3D ClassicVRML.
// [the thread that loads]
#pragma once

#include "parse/layout_recorder.h"

namespace xvrml {

class ClassicRecorder : public LayoutRecorder {
 public:
  using LayoutRecorder::LayoutRecorder;

  void placed(const char* begin, const char* end) override;
  void useNode(const Name& name) override;
  void nullNode(const Name& token) override;
  FieldTarget openField(const Name& name) override;
  void route(const Name& keyword, const RouteNames& names) override;

 private:
  NodeText begunNode(const Name& type, const Name* def) override;
  void endNode(NodeText& node) override;
  void endField(FieldText& field, bool good) override;
  size_t prototypeBegin(const Name& name, std::string_view keyword) const override {
    return keywordBefore(name, keyword);
  }
  size_t prototypeEnd() const override { return placed_.end; }

  size_t offset(const char* at) const { return size_t(at - locator_.text().data()); }
  TextSpan spanOf(const Name& name) const {
    return {offset(name.at), offset(name.at) + name.text.size()};
  }
  size_t keywordBefore(const Name& name, std::string_view keyword) const;
  FieldText begunField(std::string name, const char* at) const;
  FieldText begunDeclaration(const Name& name) const override {
    return begunField(std::string(name.text), name.at);
  }

  TextSpan placed_;
};

} // namespace xvrml
