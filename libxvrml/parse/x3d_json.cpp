// x3d_json.cpp: the reader of X3D in JSON (ISO/IEC 19776-5, as X3DJSONLD writes it): "@name" is an
// attribute, "-name" holds the child nodes of a field, "#sourceCode" the lines of a Script. Members
// of an object may have any order. Objects go to X3dElements; the walk has a stack of its own.
#include "parse/encodings.h"

#include <algorithm>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "parse/builder.h"
#include "parse/json_recorder.h"
#include "parse/source.h"
#include "parse/suffix.h"
#include "parse/x3d_elements.h"

namespace xvrml {
namespace {

using Value = JsonIndex::Value;

// Writes a string as an MFString of VRML has it.
void addQuoted(std::string& list, std::string_view string) {
  list += " \"";
  for (const char c : string) {
    if (c == '"' || c == '\\') list += '\\';
    list += c;
  }
  list += '"';
}

// Members that others refer to come first, whatever their order in the file.
bool comesFirst(std::string_view key) {
  return key == "head" || key == "ProtoInterface" || key == "field";
}

class Walk {
 public:
  // recorder: is told of each element; null: nothing is.
  Walk(Locator& locator, const JsonIndex& index, X3dElements& elements, JsonRecorder* recorder)
      : locator_(locator), index_(index), elements_(elements), recorder_(recorder) {}

  // Comments before the first node, each with an end of line.
  const std::string& comments() const { return comments_; }

  void walk() {
    if (index_.values().empty()) return;
    if (index_.values()[0].kind != Value::Kind::object) {
      locator_.error(index_.values()[0].text.data(), "expected an object, {\"X3D\": ...}");
      return;
    }
    index_.eachWithin(0, [&](size_t i) { addElements(i, 0); });
    std::reverse(tasks_.begin(), tasks_.end());
    while (!tasks_.empty()) {
      const Task task = tasks_.back();
      tasks_.pop_back();
      if (!task.closes) {
        open(task);
        continue;
      }
      elements_.close();
      if (recorder_) recorder_->leave();
    }
  }

 private:
  struct Task {
    std::string_view element; // its name
    JsonRecorder::Element place;
    std::string_view container;
    bool closes = false; // closes an element instead of opening one
  };

  const Value& at(size_t index) const { return index_.values()[index]; }

  // Opens an element, and plans what stands in it.
  void open(const Task& task) {
    decoded_.clear();
    std::vector<Attribute> attributes;
    std::string source;
    const char* sourceAt = nullptr;
    index_.eachWithin(task.place.object, [&](size_t i) {
      const Value& member = at(i);
      if (member.key.starts_with('@')) addAttribute(member, attributes);
      if (!member.key.starts_with("#source")) return;
      sourceAt = member.text.data();
      source = sourceOf(member);
    });
    if (!task.container.empty() && !findAttribute(attributes, "containerField"))
      attributes.push_back(
          {{"containerField", task.container.data()}, task.container, task.container.data()});
    if (recorder_) recorder_->enter(task.place);
    elements_.open({task.element, task.element.data()}, attributes);
    if (sourceAt) elements_.characters(source, sourceAt);
    tasks_.push_back({{}, {}, {}, true});
    const size_t first = tasks_.size();
    for (const bool early : {true, false})
      index_.eachWithin(task.place.object, [&](size_t i) {
        if (comesFirst(at(i).key) == early) addElements(i, JsonRecorder::none);
      });
    std::reverse(tasks_.begin() + static_cast<ptrdiff_t>(first), tasks_.end());
  }

  // Plans the elements that a member of an object stands for: "-children" holds objects with one
  // member each, whose name is the element's; other members are elements, or lists of them.
  // holder: the object of the member, if it may be that of a single node.
  void addElements(size_t index, size_t holder) {
    const Value& member = at(index);
    if (member.key.starts_with('@') || member.key.starts_with('#')) return;
    const bool nodes = member.key.starts_with('-');
    const auto add = [&](size_t object) {
      if (at(object).kind != Value::Kind::object) return;
      if (!nodes) return tasks_.push_back({member.key, {object, holder, JsonRecorder::none}, {}});
      index_.eachWithin(object, [&](size_t i) {
        const Value& node = at(i);
        if (node.key.starts_with('#')) return addComment(node);
        anyNode_ = true;
        if (node.kind == Value::Kind::object)
          tasks_.push_back({node.key, {i, object, index}, member.key.substr(1)});
        else
          locator_.error(node.text.data(), fmt::format("expected an object of type {}",
                                                       describe(Name{node.key, nullptr})));
      });
    };
    if (member.kind == Value::Kind::array)
      index_.eachWithin(index, add);
    else
      add(index);
  }

  void addComment(const Value& comment) {
    if (!anyNode_ && comment.kind == Value::Kind::string && comment.complete)
      comments_ += index_.decoded(comment) + '\n';
  }

  void addAttribute(const Value& member, std::vector<Attribute>& attributes) {
    const std::string_view key = member.key.substr(1);
    Attribute attribute{{key, key.data()}, member.text, member.text.data(), true};
    if (!member.complete || member.text == "null") return;
    switch (member.kind) {
    case Value::Kind::object:
      locator_.error(attribute.at, fmt::format("expected a value of {}, found an object",
                                               describe(attribute.name)));
      return;
    case Value::Kind::string:
      attribute.value = decoded_.emplace_back(index_.decoded(member));
      break;
    case Value::Kind::array:
      attribute.value = member.hasStrings ? std::string_view(listOf(member))
                                          : member.text.substr(1, member.text.size() - 2);
      break;
    case Value::Kind::other: break;
    }
    attributes.push_back(attribute);
  }

  const std::string& listOf(const Value& array) {
    std::string& list = decoded_.emplace_back();
    for (const std::string& string : index_.strings(array)) addQuoted(list, string);
    return list;
  }

  // Returns the lines of a Script's program.
  std::string sourceOf(const Value& member) const {
    if (member.kind == Value::Kind::string) return index_.decoded(member);
    std::string text;
    if (member.kind == Value::Kind::array)
      for (const std::string& line : index_.strings(member)) text += line + '\n';
    return text;
  }

  Locator& locator_;
  const JsonIndex& index_;
  X3dElements& elements_;
  JsonRecorder* const recorder_;
  std::vector<Task> tasks_;
  std::deque<std::string> decoded_; // values of the element that is opened
  std::string comments_;
  bool anyNode_ = false; // one has been planned
};

} // namespace

// Returns whether a text is X3D in JSON: an object with an X3D in it.
bool isX3dJson(std::string_view text, std::string_view file) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '{' &&
         (text.substr(first, 4096).find("\"X3D\"") != text.npos ||
          endsWithOneOf(file, {".x3dj", ".x3djz", ".x3dj.gz"}));
}

// Text that is not well-formed ends the file: what stands before is kept.
void readX3dJson(const WorldFile& file) {
  Locator locator(file.bytes, file.name, file.state.diagnostics);
  Builder builder(locator, file.state, file.content);
  const JsonIndex index(locator, file.budget);
  TextLayout* const layout = file.state.layout;
  std::optional<JsonRecorder> recorder;
  if (layout) recorder.emplace(builder, locator, *layout, index);
  ParseSink& sink = recorder ? static_cast<ParseSink&>(*recorder) : builder;
  X3dElements elements(locator, file.state.options.limits, sink, file.budget.get(),
                       file.state.anyRoots);
  Walk walk(locator, index, elements, recorder ? &*recorder : nullptr);
  walk.walk();
  setOpeningComments(file.name, walk.comments());
  elements.finish();
  builder.finish();
  if (recorder) recorder->finish(file.state.anyRoots);
}

} // namespace xvrml
