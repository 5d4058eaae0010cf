#include "as_json/edit_step.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace vv::json::edits {

namespace {

class Reader {
 public:
  std::vector<Edit> read(const std::string& where, Json& list) {
    for (size_t i = 0; i < list.size(); ++i) {
      Members members(fmt::format("{}[{}]", where, i), std::move(list[i]));
      const std::string kind = members.text("edit");
      const Row* row = std::find_if(std::begin(table), std::end(table),
                                    [&](const Row& one) { return kind == one.name; });
      if (row == std::end(table))
        throw CommandError("command", fmt::format("{}: there is no edit {}{}", members.at("edit"),
                                                  shownJson(kind), nearTo(kind, kinds())));
      edits_.push_back((this->*row->read)(members));
      members.rest();
    }
    return std::move(edits_);
  }

 private:
  struct Row {
    const char* name;
    Edit (Reader::*read)(Members& members);
  };
  static const Row table[10];

  static std::vector<std::string> kinds() {
    std::vector<std::string> names;
    for (const Row& row : table) names.emplace_back(row.name);
    return names;
  }

  // Reads {"edit": 0}, which is the node that edit 0 of the step makes, or any name of a node.
  EditedNode nodeOf(const std::string& where, const Json& json) const {
    if (!json.is_object())
      return std::visit([](const auto& name) -> EditedNode { return name; },
                        json::nodeOf(where, json));
    const auto edit = json.find("edit");
    if (json.size() != 1 || edit == json.end() || !edit->is_number_unsigned() ||
        edit->get<uint64_t>() >= edits_.size() || !makesNode(edits_[edit->get<size_t>()]))
      refuse(where, "\"edit\" with the index of an earlier edit that makes a node", json);
    return Made{edit->get<size_t>()};
  }
  static bool makesNode(const Edit& edit) {
    return std::holds_alternative<Insert>(edit) || std::holds_alternative<Duplicate>(edit) ||
           std::holds_alternative<Wrap>(edit);
  }

  EditedNode node(Members& m) const { return nodeOf(m.at("node"), m.need("node")); }

  // Reads parent, field and index.
  Place placeOf(Members& m, const char* usualField) const {
    Place place;
    if (m.has("parent"))
      if (const Json& parent = m.need("parent"); !parent.is_null())
        place.parent = nodeOf(m.at("parent"), parent);
    if (m.has("field"))
      if (const Json& field = m.need("field"); !field.is_null())
        place.field = textOf(m.at("field"), field);
    if (place.field.empty()) place.field = usualField;
    if (!place.parent) place.field.clear();
    if (m.has("index"))
      place.index = uint32_t(wholeNumberOf(m.at("index"), m.need("index"), 0, largestIndex));
    return place;
  }
  Place target(Members& m) const { return placeOf(m, "children"); }

  // Reads which of several places of a node is meant.
  std::optional<Place> at(Members& m) const {
    if (!m.has("at")) return {};
    Members members(m.at("at"), std::move(m.need("at")));
    static_cast<void>(members.need("parent"));
    const Place place = placeOf(members, "");
    members.rest();
    return place;
  }

  std::pair<EditedNode, std::string> end(Members& m, const char* name) const {
    const Json& json = m.need(name);
    const std::string where = m.at(name);
    if (!json.is_array() || json.size() != 2)
      refuse(where, "an array of a node and the name of its event", json);
    return {nodeOf(where + "[0]", json[0]), textOf(where + "[1]", json[1])};
  }

  Edit set(Members& m) {
    EditedNode edited = node(m);
    std::string field = m.text("field");
    return SetField{std::move(edited), std::move(field), std::move(m.need("value"))};
  }
  Edit insert(Members& m) { return Insert{m.text("vrml"), target(m)}; }
  Edit use(Members& m) { return Use{node(m), target(m)}; }
  Edit remove(Members& m) { return Remove{node(m), at(m)}; }
  Edit move(Members& m) { return Move{node(m), at(m), target(m)}; }
  Edit duplicate(Members& m) { return Duplicate{node(m), at(m)}; }
  Edit wrap(Members& m) {
    return Wrap{node(m), at(m), m.has("type") ? m.text("type") : "Transform"};
  }
  Edit rename(Members& m) { return Rename{node(m), m.text("name")}; }
  Edit route(Members& m) { return routeOf(m, true); }
  Edit unroute(Members& m) { return routeOf(m, false); }
  Edit routeOf(Members& m, bool add) const {
    auto [from, out] = end(m, "from");
    auto [to, in] = end(m, "to");
    return Route{std::move(from), std::move(out), std::move(to), std::move(in), add};
  }

  static constexpr int largestIndex = std::numeric_limits<int>::max();

  std::vector<Edit> edits_;
};

const Reader::Row Reader::table[10] = {
    {"set", &Reader::set},         {"insert", &Reader::insert}, {"use", &Reader::use},
    {"remove", &Reader::remove},   {"move", &Reader::move},     {"duplicate", &Reader::duplicate},
    {"wrap", &Reader::wrap},       {"rename", &Reader::rename}, {"route", &Reader::route},
    {"unroute", &Reader::unroute},
};

} // namespace

Step readStep(Members& members, size_t mostEdits) {
  Step step;
  step.name = nameOf(members.at("name"), members.need("name"));
  Json& edits = members.need("edits");
  if (!edits.is_array() || edits.empty()) refuse(members.at("edits"), "an array of objects", edits);
  if (edits.size() > mostEdits)
    throw CommandError("limit", fmt::format("{}: a step has at most edits={} edits",
                                            members.at("edits"), mostEdits));
  step.edits = Reader().read(members.at("edits"), edits);
  return step;
}

} // namespace vv::json::edits
