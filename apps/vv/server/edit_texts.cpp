#include "server/edit_texts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "edit/actions.h"
#include "server/limits.h"
#include "xvrml/numbers.h"

namespace vv::server::edit {

using namespace xvrml;
using json::Json;
using json::jsonText;

namespace {

constexpr size_t mostNameBytes = 1024, mostNoteBytes = 400, mostHelpBytes = 1000, mostFrames = 1200;

std::string written(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string shortened(const std::string& text, size_t most) {
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

// Returns how many bytes of JSON a value takes at most, about; much for what is not shown.
size_t roughSize(const Value& value) {
  constexpr size_t numberBytes = 25;
  return std::visit(
      [](const auto& one) -> size_t {
        using T = std::remove_cvref_t<decltype(one)>;
        using Element = ElementOf<T>;
        if constexpr (std::is_same_v<T, std::string>) {
          return one.size();
        } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
          size_t sum = 0;
          for (const std::string& text : one) sum += text.size() + 3;
          return sum;
        } else if constexpr (std::is_same_v<Element, Image>) {
          return size_t(maxValueBytes) + 1; // pages have no widget for pictures
        } else if constexpr (Numeric<Element>) {
          const size_t each = size_t(numberCount<Element>) * numberBytes;
          if constexpr (isList<T>) return one.size() * each;
          return each;
        } else if constexpr (isList<T>) {
          return one.size() * 6;
        } else {
          return 6;
        }
      },
      value);
}

// Returns the nodes that a field holds, as links.
void appendLinks(std::string& out, const Value& value, json::NodeNumbers& numbers) {
  const auto link = [&](const NodeRef& node) {
    out += out.ends_with('[') ? "" : ",";
    if (node)
      fmt::format_to(std::back_inserter(out), R"({{"node":{},"label":{}}})", numbers.of(node),
                     jsonText(labelOf(*node)));
    else
      out += "null";
  };
  out += ",\"links\":[";
  if (const auto* one = std::get_if<NodeRef>(&value)) link(*one);
  if (const auto* many = std::get_if<MFNode>(&value))
    for (const NodeRef& node : *many) link(node);
  out += ']';
}

// An input of a page has closed ranges only.
void appendRange(std::string& out, const FieldRange& range) {
  if (std::isfinite(range.minimum))
    fmt::format_to(std::back_inserter(out), R"(,"least":{})", range.minimum);
  if (std::isfinite(range.maximum))
    fmt::format_to(std::back_inserter(out), R"(,"most":{})", range.maximum);
}

// Colours are codes of sRGB, as they stand in files, except the parameters of shaders.
bool isLinear(const Node& node, const PropertyRow& row) {
  return node.type().is("shader") && (row.field->declared || !row.isDeclared);
}

std::string rowText(const Node& node, const PropertyRow& row, json::NodeNumbers& numbers) {
  const FieldInfo& field = *row.field;
  std::string out =
      fmt::format(R"({{"field":{},"type":"{}","default":{},"declared":{},"size":{},"help":{})",
                  jsonText(field.name), fieldTypeName(field.type), row.isDefault, row.isDeclared,
                  row.size, jsonText(shortened(row.help, mostHelpBytes)));
  appendRange(out, row.range);
  if (isLinear(node, row)) out += ",\"linear\":true";
  if (!row.choices.empty()) out += ",\"choices\":" + written(row.choices);
  if (row.isLong || row.isInOptions || roughSize(row.value) > size_t(maxValueBytes)) {
    out += ",\"long\":true";
  } else if (field.type == FieldType::SFNode || field.type == FieldType::MFNode) {
    appendLinks(out, row.value, numbers);
  } else {
    out += ",\"value\":";
    json::appendValue(out, row.value, {});
  }
  return out + "}";
}

const char* nameOf(Probe::State state) {
  switch (state) {
  case Probe::State::waiting: return "waiting";
  case Probe::State::hidden: return "hidden";
  case Probe::State::outside: return "outside";
  case Probe::State::otherView: return "other_view";
  case Probe::State::read: break;
  }
  return "read";
}

} // namespace

std::string editorText() {
  Json kinds = Json::array();
  for (const NewNode& one : newNodes()) kinds.push_back(one.name);
  kinds.push_back(viewpointKind);
  return written({{"type", "editor"},
                  {"kinds", kinds},
                  {"mostBytes", maxEditBytes},
                  {"mostRows", maxRowsShown},
                  {"mostElements", PropertySheet::mostElements}});
}

std::string rowsText(const EditModel& model, json::NodeNumbers& numbers, int first, int count) {
  const std::vector<OutlineRow>& all = model.rows();
  Json rows = Json::array();
  const size_t begin = std::min(size_t(first), all.size()),
               end = std::min(begin + size_t(count), all.size());
  for (size_t i = begin; i < end; ++i) {
    const OutlineRow& row = all[i];
    Json one = {{"node", numbers.of(row.node)}, {"depth", row.depth}, {"label", row.label}};
    if (row.canOpen && !row.isUse) one["open"] = row.isOpen;
    if (row.isUse) one["use"] = true;
    if (model.isSelected(*row.node)) one["selected"] = true;
    rows.push_back(std::move(one));
  }
  return written({{"type", "rows"}, {"first", begin}, {"total", all.size()}, {"rows", rows}});
}

std::string revealText(int row) { return written({{"type", "reveal"}, {"row", row}}); }

std::string sheetText(const PropertySheet& sheet, json::NodeNumbers& numbers) {
  if (!sheet.node) return R"({"type":"sheet","node":null,"title":"","note":"","fields":[]})";
  const std::string& name = sheet.node->defName;
  std::string out =
      fmt::format(R"({{"type":"sheet","node":{},"title":{},"note":{})", numbers.of(sheet.node),
                  jsonText(sheet.title), jsonText(shortened(sheet.note, mostNoteBytes)));
  if (name.size() <= mostNameBytes) out += ",\"name\":" + jsonText(name);
  out += ",\"fields\":[";
  size_t shown = 0;
  for (const PropertyRow& row : sheet.rows) {
    const std::string text = rowText(*sheet.node, row, numbers);
    if (out.size() + text.size() > size_t(maxSheetBytes)) break;
    if (shown++) out += ',';
    out += text;
  }
  return out + fmt::format(R"(],"hidden":{}}})", sheet.rows.size() - shown);
}

std::string framesText(const EditModel& model) {
  std::string lines;
  size_t count = 0;
  for (const EditModel::Line& line : model.frames()) {
    if (++count > mostFrames) break;
    fmt::format_to(std::back_inserter(lines), "{}[{:.4f},{:.4f},{:.4f},{:.4f}]",
                   count > 1 ? "," : "", line.x0, line.y0, line.x1, line.y1);
  }
  return fmt::format(R"({{"type":"frames","lines":[{}]}})", lines);
}

std::string historyText(WorldEditor& editor, const std::string& readOnly) {
  const std::optional<FoundJournal>& left = editor.journal().left();
  return written({{"type", "history"},
                  {"undo", shortened(editor.editor().undoName(), mostNoteBytes)},
                  {"redo", shortened(editor.editor().redoName(), mostNoteBytes)},
                  {"unsaved", editor.isChanged()},
                  {"readOnly", readOnly},
                  {"selected", editor.selection().size()},
                  {"left", left ? Json(left->written) : Json()}});
}

std::string probesText(const Probes& probes) {
  const std::vector<std::optional<Difference>> changes = probes.differences();
  Json list = Json::array();
  for (size_t i = 0; i < changes.size(); ++i) {
    const Probe& probe = probes.all()[i];
    Json one = {{"number", probe.number}, {"state", nameOf(probe.state)}};
    if (probe.state == Probe::State::read) {
      one["luminance"] = probe.now.luminance;
      one["half_width"] = probe.now.luminanceHalfWidth;
      one["trusted"] = probe.now.trusted;
    }
    if (changes[i]) {
      one["change"] = changes[i]->value;
      one["change_half_width"] = changes[i]->halfWidth;
      one["significant"] = changes[i]->isSignificant;
    }
    list.push_back(std::move(one));
  }
  return written({{"type", "probes"}, {"list", list}});
}

std::string saidText(const std::string& text, bool isError) {
  return written({{"type", "said"}, {"text", shortened(text, mostNoteBytes)}, {"error", isError}});
}

std::string questionText() {
  return written({{"type", "question"},
                  {"text", "Another program has changed or removed the file since it was read."}});
}

} // namespace vv::server::edit
