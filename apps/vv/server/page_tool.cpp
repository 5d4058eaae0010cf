#include "server/page_tool.h"

#include <utility>

namespace vv::server {

using xvrml::EditError;

void PageTool::take(const edit::ToolCommand& command, WorldEditor& editor, const EditView& view) {
  std::visit([&](const auto& one) { perform(one, editor, view); }, command);
}

void PageTool::accept(WorldEditor& editor) {
  if (const auto tool = std::exchange(tool_, nullptr)) tool->accept(editor);
}

void PageTool::place(WorldEditor& editor, const EditView& view, bool isEditable) {
  if (isEditable)
    gizmo_.place(editor, view);
  else
    gizmo_.clear();
}

void PageTool::perform(const edit::BeginTool& begin, WorldEditor& editor, const EditView& view) {
  using Kind = TransformTool::Kind;
  constexpr Kind kinds[] = {Kind::move, Kind::turn, Kind::scale};
  if (const std::string why = editor.editor().whyReadOnly(); !why.empty()) throw EditError(why);
  pointer_ = begin.place;
  tool_ = std::make_unique<TransformTool>(editor, kinds[size_t(begin.kind)], view, pointer_.x,
                                          pointer_.y);
  if (begin.axis >= 0) tool_->chooseAxis(begin.axis);
}

void PageTool::perform(const edit::PointTool& point, WorldEditor& editor, const EditView&) {
  if (!tool_) return;
  pointer_ = point.place;
  tool_->setSnap(point.snap);
  tool_->point(editor, pointer_.x, pointer_.y);
}

void PageTool::perform(const edit::TypeTool& type, WorldEditor& editor, const EditView&) {
  if (!tool_) return;
  if (type.key == "X" || type.key == "Y" || type.key == "Z")
    tool_->chooseAxis(type.key[0] - 'X');
  else if (!tool_->type(type.key))
    return;
  tool_->point(editor, pointer_.x, pointer_.y);
}

void PageTool::perform(const edit::EndTool& end, WorldEditor& editor, const EditView&) {
  if (end.accept) return accept(editor);
  if (const auto tool = std::exchange(tool_, nullptr)) tool->cancel(editor);
}

void PageTool::perform(const edit::NextHandles&, WorldEditor&, const EditView&) { gizmo_.cycle(); }

} // namespace vv::server
