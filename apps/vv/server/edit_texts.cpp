#include "server/edit_texts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <type_traits>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "base64.h"
#include "libpicture/files/formats.h"
#include "server/limits.h"
#include "xvrml/numbers.h"

namespace vv::server::edit {

using namespace xvrml;
using json::Json;
using json::jsonLine;
using json::jsonText;

namespace {

constexpr size_t mostNameBytes = 1024, mostNoteBytes = 400, mostHelpBytes = 1000, mostFrames = 1200;

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
void appendLinks(std::string& out, const PropertyRow& row, json::NodeNumbers& numbers) {
  size_t count = 0;
  const auto link = [&](const NodeRef& node) {
    const size_t index = count++;
    out += index > 0 ? "," : "";
    if (!node) {
      out += "null";
      return;
    }
    fmt::format_to(std::back_inserter(out), R"({{"node":{},"label":{},"places":{}}})",
                   numbers.of(node), jsonText(labelOf(*node)),
                   index < row.places.size() ? row.places[index] : 1);
  };
  out += ",\"links\":[";
  if (const auto* one = std::get_if<NodeRef>(&row.value)) link(*one);
  if (const auto* many = std::get_if<MFNode>(&row.value))
    for (const NodeRef& node : *many) link(node);
  out += ']';
}

const char* nameOf(std::optional<Gizmo::Kind> kind) {
  if (!kind) return "none";
  switch (*kind) {
  case Gizmo::Kind::move: return "move";
  case Gizmo::Kind::turn: return "turn";
  case Gizmo::Kind::scale: break;
  }
  return "scale";
}

const char* nameOf(Severity severity) {
  switch (severity) {
  case Severity::error: return "error";
  case Severity::warning: return "warning";
  default: return "note";
  }
}

// Appends lines of the picture as an array.
void appendLines(std::string& out, std::span<const EditModel::Line> lines) {
  out += '[';
  for (size_t i = 0; i < lines.size(); ++i)
    fmt::format_to(std::back_inserter(out), "{}[{:.4f},{:.4f},{:.4f},{:.4f}]", i > 0 ? "," : "",
                   lines[i].x0, lines[i].y0, lines[i].x1, lines[i].y1);
  out += ']';
}

// An input of a page has closed ranges only.
void appendRange(std::string& out, const FieldRange& range) {
  if (std::isfinite(range.minimum))
    fmt::format_to(std::back_inserter(out), R"(,"least":{})", range.minimum);
  if (std::isfinite(range.maximum))
    fmt::format_to(std::back_inserter(out), R"(,"most":{})", range.maximum);
}

std::string rowText(const PropertyRow& row, json::NodeNumbers& numbers) {
  const FieldInfo& field = *row.field;
  std::string out =
      fmt::format(R"({{"field":{},"type":"{}","default":{},"declared":{},"size":{},"help":{})",
                  jsonText(field.name), fieldTypeName(field.type), row.isDefault, row.isDeclared,
                  row.size, jsonText(shortened(row.help, mostHelpBytes)));
  appendRange(out, row.range);
  if (row.isLinear) out += ",\"linear\":true";
  if (row.edits > 0) out += ",\"edited\":true";
  if (!row.choices.empty()) out += ",\"choices\":" + jsonLine(row.choices);
  if (row.isLong || roughSize(row.value) > size_t(maxValueBytes)) {
    out += ",\"long\":true";
  } else if (field.type == FieldType::SFNode || field.type == FieldType::MFNode) {
    appendLinks(out, row, numbers);
  } else {
    out += ",\"value\":";
    json::appendValue(out, row.value, {});
  }
  return out + "}";
}

} // namespace

std::string rowsText(const EditModel& model, json::NodeNumbers& numbers, int first, int count) {
  const std::vector<OutlineRow>& all = model.rows();
  Json rows = Json::array();
  const size_t begin = std::min(size_t(first), all.size()),
               end = std::min(begin + size_t(count), all.size());
  for (size_t i = begin; i < end; ++i) {
    const OutlineRow& row = all[i];
    Json one = {{"node", numbers.of(row.node)}, {"depth", row.depth}, {"label", row.label()}};
    if (row.canOpen && !row.isUse) one["open"] = row.isOpen;
    if (row.isUse) one["use"] = true;
    if (model.isSelected(*row.node)) one["selected"] = true;
    if (row.place.parent) {
      one["parent"] = numbers.of(row.place.parent);
      one["field"] = row.place.field;
    }
    one["index"] = row.place.index;
    rows.push_back(std::move(one));
  }
  return jsonLine({{"type", "rows"}, {"first", begin}, {"total", all.size()}, {"rows", rows}});
}

std::string revealText(int row) { return jsonLine({{"type", "reveal"}, {"row", row}}); }

std::string sheetText(const PropertySheet& sheet, json::NodeNumbers& numbers) {
  if (!sheet.node) return R"({"type":"sheet","node":null,"title":"","note":"","fields":[]})";
  const std::string& name = sheet.node->defName;
  std::string out =
      fmt::format(R"({{"type":"sheet","node":{},"title":{},"note":{})", numbers.of(sheet.node),
                  jsonText(sheet.title), jsonText(shortened(sheet.note, mostNoteBytes)));
  if (name.size() <= mostNameBytes) out += ",\"name\":" + jsonText(name);
  if (sheet.hasLook)
    out += fmt::format(R"(,"look":{{"name":{},"surface":{},"places":{},"option":{}}})",
                       jsonText(shortened(sheet.look.name, mostNameBytes)),
                       sheet.look.surface ? std::to_string(numbers.of(sheet.look.surface)) : "null",
                       sheet.look.places, jsonText(sheet.shaderOption));
  out += ",\"fields\":[";
  size_t shown = 0;
  for (const PropertyRow& row : sheet.rows) {
    const std::string text = rowText(row, numbers);
    if (out.size() + text.size() > size_t(maxSheetBytes)) break;
    if (shown++) out += ',';
    out += text;
  }
  return out + fmt::format(R"(],"hidden":{}}})", sheet.rows.size() - shown);
}

std::string thumbnailsText(const TextureThumbnails& thumbnails, json::NodeNumbers& numbers) {
  Json list = Json::array();
  for (const NodeRef& node : thumbnails.nodes()) {
    Json one = {{"node", numbers.of(node)}};
    const Thumbnail& shown = *thumbnails.of(*node);
    if (shown.error.empty()) {
      one["image"] = base64Of(picture::pngOf(shown.rgba, shown.width, shown.height, 4));
      one["scale"] = shown.magnification();
    } else {
      one["error"] = shortened(shown.error, mostNoteBytes);
    }
    list.push_back(std::move(one));
  }
  return jsonLine({{"type", "thumbnails"}, {"list", list}});
}

std::string looksText(const std::vector<ShownLook>& looks) {
  Json list = Json::array();
  for (const ShownLook& one : looks) {
    Json look = {{"number", one.number},
                 {"name", shortened(one.look->name, mostNameBytes)},
                 {"text", shortened(one.look->text, mostNoteBytes)},
                 {"shader", one.look->isShader()},
                 {"own", !one.look->file.empty()}};
    if (!one.image.empty()) look["image"] = one.image;
    list.push_back(std::move(look));
  }
  return jsonLine({{"type", "looks"}, {"list", list}});
}

std::string choicesText(uint64_t node, const PropertyRow& row, json::NodeNumbers& numbers) {
  Json types = Json::array(), uses = Json::array();
  for (const NodeType* type : row.addable)
    types.push_back({{"name", type->name}, {"text", shortened(type->text, mostNoteBytes)}});
  for (const NodeRef& used : row.usable)
    uses.push_back({{"node", numbers.of(used)}, {"label", labelOf(*used)}});
  return jsonLine({{"type", "choices"},
                   {"node", node},
                   {"field", row.field->name},
                   {"types", types},
                   {"uses", uses}});
}

std::string problemsText(const ProblemList& problems, json::NodeNumbers& numbers) {
  Json rows = Json::array();
  uint64_t dropped = 0;
  if (problems.isOpen()) {
    const size_t shown = std::min(problems.rows().size(), size_t(maxProblemsShown));
    dropped = problems.dropped() + problems.rows().size() - shown;
    for (size_t i = 0; i < shown; ++i) {
      const ProblemRow& row = problems.rows()[i];
      Json one = {{"severity", nameOf(row.severity)},
                  {"text", shortened(problemText(row), mostHelpBytes)},
                  {"line", shortened(row.sourceLine, mostNoteBytes)}};
      if (row.node) {
        one["node"] = numbers.of(row.node);
        one["label"] = row.label;
      }
      rows.push_back(std::move(one));
    }
  }
  return jsonLine({{"type", "problems"},
                   {"count", problems.count()},
                   {"open", problems.isOpen()},
                   {"rows", rows},
                   {"dropped", dropped}});
}

std::string framesText(const EditModel& model) {
  const std::vector<EditModel::Line>& frames = model.frames();
  std::string out = R"({"type":"frames","lines":)";
  appendLines(out, std::span(frames).first(std::min(frames.size(), mostFrames)));
  return out + "}";
}

std::string handlesText(const Gizmo& gizmo) {
  std::string out = fmt::format(R"({{"type":"handles","kind":"{}","list":[)", nameOf(gizmo.kind()));
  for (const Gizmo::Handle& handle : gizmo.handles()) {
    out += fmt::format(R"({}{{"axis":{},"opposite":{},"end":[{:.4f},{:.4f}],"lines":)",
                       out.ends_with('[') ? "" : ",", handle.axis, handle.isOpposite, handle.end[0],
                       handle.end[1]);
    appendLines(out, handle.lines);
    out += '}';
  }
  return out + "]}";
}

std::string toolText(const std::string& text) {
  return jsonLine({{"type", "tool"}, {"text", shortened(text, mostNoteBytes)}});
}

std::string historyText(WorldEditor& editor, const std::string& readOnly, size_t hidden) {
  const std::optional<FoundJournal>& left = editor.journal().left();
  return jsonLine({{"type", "history"},
                   {"undo", shortened(editor.editor().undoName(), mostNoteBytes)},
                   {"redo", shortened(editor.editor().redoName(), mostNoteBytes)},
                   {"unsaved", editor.isChanged()},
                   {"readOnly", readOnly},
                   {"selected", editor.selection().size()},
                   {"hidden", hidden},
                   {"left", left ? Json(left->written) : Json()}});
}

std::string saidText(const std::string& text, bool isError) {
  return jsonLine({{"type", "said"}, {"text", shortened(text, mostNoteBytes)}, {"error", isError}});
}

std::string importText(size_t received, size_t bytes) {
  return jsonLine({{"type", "import"}, {"received", received}, {"bytes", bytes}});
}

std::string questionText() {
  return jsonLine({{"type", "question"},
                   {"text", "Another program has changed or removed the file since it was read."}});
}

} // namespace vv::server::edit
