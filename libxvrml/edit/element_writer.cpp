// element_writer.cpp: the nodes of X3D in XML (ISO/IEC 19776-1). A node is an element, values are
// attributes of its start tag, and nodes are elements within it, of all fields in one list.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/x3d.h"
#include "edit/changed_value.h"
#include "edit/lines.h"
#include "edit/node_writer.h"
#include "graph/field_access.h"
#include "graph/node_kinds.h"
#include "write/xml_escape.h"

namespace xvrml {
namespace {

using Kind = ListStep::Kind;

// A part of a start tag that gets another text.
struct TagChange {
  TextSpan span;
  std::string text;
};

struct AddedAttribute {
  std::string_view name;
  std::string value; // as it stands between the quotes
};

// Brings the items of several fields of an element into the order of the text. An item without a
// neighbour in its field goes behind the last element that stays.
std::vector<ListItem> inOrder(std::vector<std::vector<ListItem>> lists) {
  constexpr size_t none = ~size_t(0);
  size_t last = none;
  for (const auto& list : lists)
    for (const ListItem& item : list)
      if (item.kind == Kind::keep || item.kind == Kind::replace)
        last = last == none ? item.span.begin : std::max(last, item.span.begin);
  struct Placed {
    size_t place;
    int rank; // before, at, or behind the place
    ListItem item;
  };
  std::vector<Placed> all;
  for (auto& list : lists) {
    size_t behind = none; // the place before the item
    for (size_t i = 0; i < list.size(); ++i) {
      const ListItem& item = list[i];
      if (item.hasPlace()) {
        all.push_back({item.span.begin, 1, item});
        if (item.kind != Kind::remove) behind = item.span.begin;
      } else if (item.kind == Kind::before) {
        const auto next = std::find_if(list.begin() + std::ptrdiff_t(i), list.end(),
                                       [](const ListItem& one) { return one.hasPlace(); });
        all.push_back({next->span.begin, 0, item});
      } else {
        all.push_back({behind == none ? last : behind, behind == none ? 3 : 2, item});
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) {
    return std::pair(a.place, a.rank) < std::pair(b.place, b.rank);
  });
  std::vector<ListItem> items;
  for (Placed& one : all) items.push_back(std::move(one.item));
  return items;
}

class ElementWriter : public NodeWriter {
 public:
  using NodeWriter::NodeWriter;

 private:
  void writeRoots(const DocumentText& file) override {
    writeContent(file, *file.layout.xml.scene(),
                 itemsOf(file, file.layout.roots, document_.scope().roots, {}), true);
  }

  std::string routeText(const Route& route) const {
    const char quote = document_.file().layout.xml.quote();
    return fmt::format("<ROUTE{}{}{}{}/>", attribute("fromNode", route.from->defName, quote),
                       attribute("fromField", spelled(*route.from, route.fromField), quote),
                       attribute("toNode", route.to->defName, quote),
                       attribute("toField", spelled(*route.to, route.toField), quote));
  }

  std::string useOf(const Node& node, const Holder& holder) const override {
    const char quote = document_.file().layout.xml.quote();
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    const std::string_view name = node.type().name;
    std::string text = fmt::format("<{}", instance ? "ProtoInstance" : name);
    if (instance) text += attribute("name", name, quote);
    text += attribute("USE", node.defName, quote);
    if (needsContainer(node, holder))
      text += attribute("containerField", spelled(*holder.parent, holder.field->name), quote);
    return text + "/>";
  }

  void keepUse(const DocumentText& text, const NodePlace& place) override {
    const XmlIndex& xml = text.layout.xml;
    const XmlAttribute* const use = xml.find(xml.at(place.span.begin), "USE");
    text_.replaceName(text, xml.trimmedValue(*use), *place.node);
    text_.copy(text, place.span.end);
  }

  CommentedNode commented(std::string_view text, const TextSpan& node) const override {
    return commentedXmlNode(text, node);
  }
  bool endsLine(std::string_view text, size_t at) const override { return endsXmlLine(text, at); }
  std::string indented(std::string_view text, std::string_view from,
                       std::string_view to) const override {
    return indentedXml(text, from, to);
  }

  static std::string escaped(std::string_view text, char quote) {
    std::string out;
    escapeXml(out, text, {&quote, 1});
    return out;
  }
  // Returns an attribute with a blank before it.
  static std::string attribute(std::string_view name, std::string_view value, char quote) {
    return fmt::format(" {}={}{}{}", name, quote, escaped(value, quote), quote);
  }
  // Returns the quotes that an element has around its values, or the file.
  char quoteOf(const DocumentText& text, const XmlElement& element) const {
    const auto attributes = text.layout.xml.attributesOf(element);
    return attributes.empty() ? document_.file().layout.xml.quote()
                              : text.text[attributes.back().value.begin - 1];
  }

  // Returns the name that our table has for a field of X3D.
  static std::string_view own(const Node& node, std::string_view name) {
    return node.type().index >= 0 ? ownName(node.type().name, name) : name;
  }

  // Returns whether a node must say which field of its parent it stands in. Other browsers take
  // "children" for an instance that does not.
  bool needsContainer(const Node& node, const Holder& holder) const {
    if (!holder.field) return false;
    const std::string_view usual =
        usualField(holder.parent->type(), effectiveType(node), document_.world().head.version);
    return own(*holder.parent, usual) != holder.field->name ||
           (nodeCast<ProtoInstance>(&node) &&
            own(*holder.parent, "children") != holder.field->name);
  }

  void writeNodeText(const Node& node, const Holder* holder) override {
    const DocumentText& text = document_.textOf(node);
    const NodeText& place = document_.placeOf(node);
    const XmlElement& element = text.layout.xml.at(place.whole.begin);
    begin(node);
    std::vector<TagChange> changes;
    std::vector<AddedAttribute> added;
    changeName(changes, text, element, node);
    if (holder && holder->field) changeContainer(changes, added, text, element, node, *holder);
    std::vector<std::vector<ListItem>> lists;
    const auto given = lastOf(place);
    for (const FieldText& field : place.fields) {
      if (given.at(field.name) != &field || !field.faithful) {
        lists.push_back(keptItems(text, field));
        continue;
      }
      const FieldInfo& info = *node.type().find(field.name);
      if (field.form == FieldForm::children)
        lists.push_back(itemsOf(text, field.nodes, nodesOf(node, info), {&node, &info}));
      else if (field.form == FieldForm::element)
        lists.push_back(
            {{Kind::keep,
              field.whole,
              [this, &text, &node, &info, &field] { writeFieldElement(text, node, info, field); },
              {}}});
      else
        changeValue(changes, text, element, node, info, field.value);
    }
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field) && !given.contains(field.name) && editedFrom(node, field))
        addField(lists, added, text, element, node, field);
    writeTag(text, element, std::move(changes), added);
    writeContent(text, element, inOrder(std::move(lists)), false);
  }

  // Returns what a field has that is not edited itself.
  std::vector<ListItem> keptItems(const DocumentText& text, const FieldText& field) {
    std::vector<ListItem> items;
    if (field.form == FieldForm::element)
      items.push_back({Kind::keep,
                       field.whole,
                       [this, &text, &field] {
                         keepNodes(text, field);
                         text_.copy(text, field.whole.end);
                       },
                       {}});
    else
      for (const NodePlace& one : field.nodes)
        items.push_back({Kind::keep, one.span, [this, &text, one] { keep(text, one, {}); }, {}});
    return items;
  }

  void changeName(std::vector<TagChange>& changes, const DocumentText& text,
                  const XmlElement& element, const Node& node) const {
    if (document_.nameInText(node) == node.defName) return;
    const char quote = quoteOf(text, element);
    if (const XmlAttribute* const def = text.layout.xml.find(element, "DEF"))
      changes.push_back({def->value, escaped(node.defName, quote)});
    else if (!node.defName.empty())
      changes.push_back(
          {{element.name.end, element.name.end}, attribute("DEF", node.defName, quote)});
  }

  void changeContainer(std::vector<TagChange>& changes, std::vector<AddedAttribute>& added,
                       const DocumentText& text, const XmlElement& element, const Node& node,
                       const Holder& holder) const {
    const std::string_view wanted = spelled(*holder.parent, holder.field->name);
    const XmlAttribute* const given = text.layout.xml.find(element, "containerField");
    if (!given) {
      if (needsContainer(node, holder)) added.push_back({"containerField", std::string(wanted)});
      return;
    }
    const TextSpan span = text.layout.xml.trimmedValue(*given);
    const std::string_view present = std::string_view(text.text).substr(span.begin, span.size());
    if (own(*holder.parent, present) != holder.field->name)
      changes.push_back({given->value, std::string(wanted)});
  }

  // Changes the value of an attribute, if it has been edited.
  void changeValue(std::vector<TagChange>& changes, const DocumentText& text,
                   const XmlElement& element, const Node& node, const FieldInfo& field,
                   const TextSpan& value) const {
    const Value* const original = editedFrom(node, field);
    if (!original) return;
    const std::string_view present = std::string_view(text.text).substr(value.begin, value.size());
    changes.push_back(
        {value, changedAttribute(present, field.type, *original, node.get(field),
                                 linesAt(text, element.begin), text.text[value.begin - 1])});
  }

  // Adds a field that the text does not have: an attribute, child elements or a fieldValue.
  void addField(std::vector<std::vector<ListItem>>& lists, std::vector<AddedAttribute>& added,
                const DocumentText& text, const XmlElement& element, const Node& node,
                const FieldInfo& field) {
    const char quote = quoteOf(text, element);
    const ValueLines lines = linesAt(text, element.begin);
    if (nodeCast<ProtoInstance>(&node)) {
      lists.push_back(
          {{Kind::behind, {}, {}, [this, &node, &field, quote](std::string_view indentation, bool) {
              return fieldValue(node, field, indentation, quote);
            }}});
    } else if (holdsNodes(field)) {
      lists.push_back(itemsOf(text, {}, nodesOf(node, field), {&node, &field}));
    } else {
      added.push_back(
          {spelled(node, field.name), attributeText(field.type, node.get(field), lines, quote)});
    }
  }

  std::string fieldValue(const Node& node, const FieldInfo& field, std::string_view indentation,
                         char quote) {
    std::string out = "<fieldValue" + attribute("name", field.name, quote);
    if (!holdsNodes(field))
      return out + fmt::format(" value={}{}{}/>", quote,
                               attributeText(field.type, node.get(field),
                                             {indentation.size(), feed_}, quote),
                               quote);
    out += ">";
    const std::string inner = deeper(indentation);
    for (const NodeRef& child : nodesOf(node, field))
      out += feed_ + inner + nodeInLines(child.get(), inner, {});
    return out + feed_ + std::string(indentation) + "</fieldValue>";
  }

  // Writes a field or fieldValue.
  void writeFieldElement(const DocumentText& text, const Node& node, const FieldInfo& field,
                         const FieldText& place) {
    const XmlElement& element = text.layout.xml.at(place.whole.begin);
    if (holdsNodes(field))
      return writeContent(text, element, itemsOf(text, place.nodes, nodesOf(node, field), {}),
                          false);
    std::vector<TagChange> changes;
    std::vector<AddedAttribute> added;
    if (place.value.begin > 0)
      changeValue(changes, text, element, node, field, place.value);
    else if (editedFrom(node, field))
      added.push_back(
          {"value", attributeText(field.type, node.get(field), linesAt(text, element.begin),
                                  quoteOf(text, element))});
    writeTag(text, element, std::move(changes), added);
    text_.copy(text, element.end);
  }

  // Writes a start tag up to the bytes that end it. New attributes go behind the last one, in
  // lines of their own if that begins a line.
  void writeTag(const DocumentText& text, const XmlElement& element, std::vector<TagChange> changes,
                const std::vector<AddedAttribute>& added) {
    std::stable_sort(changes.begin(), changes.end(), [](const TagChange& a, const TagChange& b) {
      return a.span.begin < b.span.begin;
    });
    for (const TagChange& change : changes) {
      text_.copy(text, change.span.begin);
      text_.out += change.text;
      text_.at = change.span.end;
    }
    if (added.empty()) return;
    const auto attributes = text.layout.xml.attributesOf(element);
    const char quote = quoteOf(text, element);
    std::string before = " ";
    if (attributes.empty()) {
      text_.copy(text, element.name.end);
    } else {
      const TextSpan last = attributes.back().whole();
      if (startsLine(text.text, last.begin))
        before = feed_ + std::string(indentationAt(text, last.begin));
      text_.copy(text, last.end);
    }
    for (const AddedAttribute& one : added)
      text_.out += fmt::format("{}{}={}{}{}", before, one.name, quote, one.value, quote);
  }

  // Writes what stands between the tags of an element, and its end tag. withRoutes: the routes that
  // are to be added stand at the end.
  void writeContent(const DocumentText& text, const XmlElement& element,
                    const std::vector<ListItem>& items, bool withRoutes) {
    const std::string_view all = text.text;
    const std::string outer(indentationAt(text, element.begin));
    const ListItem* const first = inLine(all, items);
    const std::string inner(first ? std::string(indentationAt(text, first->span.begin))
                                  : deeper(outer));
    const auto routeItems = [&] {
      std::vector<ListItem> routes;
      if (withRoutes)
        for (const Route* route : routesToAdd())
          routes.push_back({Kind::behind, {}, {}, [this, route](std::string_view, bool) {
                              return routeText(*route);
                            }});
      return routes;
    };
    if (!element.isEmptyTag()) {
      writeList({text, element.endTag, outer, inner}, items);
      text_.copy(text, lastContent(all, element));
      writeList({text, element.endTag, outer, inner}, routeItems());
      return text_.copy(text, element.end);
    }
    std::string content;
    for (const ListItem& item : items) content += feed_ + inner + item.make(inner, true);
    for (const ListItem& item : routeItems()) content += feed_ + inner + item.make(inner, true);
    if (!content.empty()) { // <A/> becomes <A> and </A>
      size_t slash = element.end - 2;
      while (slash > text_.at &&
             (isBlank(all[slash - 1]) || all[slash - 1] == '\n' || all[slash - 1] == '\r'))
        --slash;
      text_.copy(text, slash);
      text_.out += ">" + content + feed_ + outer + "</" +
                   text.text.substr(element.name.begin, element.name.size()) + ">";
      text_.at = element.end;
    }
    text_.copy(text, element.end);
  }

  // Returns the end of the content of an element, without the line of its end tag.
  static size_t lastContent(std::string_view text, const XmlElement& element) {
    return startsLine(text, element.endTag) ? lineBegin(text, element.endTag) : element.endTag;
  }
};

} // namespace

std::unique_ptr<NodeWriter> makeElementWriter(const Document& document, WritingPlan plan) {
  return std::make_unique<ElementWriter>(document, std::move(plan));
}

} // namespace xvrml
