// xvrml_edit.cpp: edits arbitrary files in place. The first bytes choose what is done to which
// nodes, and the encoding; the rest is the file. Each edit is done or refused, each text reads back
// as the edited world, or is refused, and undo gives the file back.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <unistd.h>

#include "fuzz_world.h"
#include "xvrml/edit.h"
#include "xvrml/numbers.h"
#include "xvrml/walk.h"

namespace {

using namespace xvrml;

constexpr size_t steps = 8, bytesOfStep = 4;
constexpr size_t mostNodes = 200; // of a file, so that a run is short

std::vector<Node*> nodesOf(const World& world) {
  std::vector<Node*> nodes;
  walk(rootsOf(world.scope), [&](Node& one, std::vector<Node*>& open) {
    nodes.push_back(&one);
    appendChildren(one, open);
    return nodes.size() < mostNodes;
  });
  return nodes;
}

// Changes elements of a list, or bytes of an image, at the places that two bytes choose.
template <class T> void changeAtPlaces(T& value, uint8_t one, uint8_t other) {
  if constexpr (std::is_same_v<T, Image>) {
    if (value.pixels.empty()) return;
    for (const uint8_t place : {one, other}) value.pixels[place % value.pixels.size()] ^= place;
  } else if constexpr (isList<T> && !std::is_same_v<T, MFNode>) {
    if (value.empty()) value.resize(one % 3u);
    for (const uint8_t choice : {one, other}) {
      if (value.empty()) return;
      const size_t place = choice / 4u % value.size();
      const auto at = value.begin() + std::ptrdiff_t(place);
      const ElementOf<T> element = value[(place + 1) % value.size()];
      switch (choice % 4) {
      case 0: value.erase(at); break;
      case 1: value.insert(at, element); break;
      case 2: value.push_back(element); break;
      default: value[place] = element;
      }
    }
  }
}

// Sets a field to its default, or changes a part of its value.
void setField(Editor& editor, Node& node, std::array<uint8_t, bytesOfStep> choice) {
  std::vector<const FieldInfo*> fields;
  for (const FieldInfo& field : node.type().fields)
    if (holdsValue(field) && field.type != FieldType::SFNode && field.type != FieldType::MFNode)
      fields.push_back(&field);
  if (fields.empty()) return;
  const FieldInfo& field = *fields[choice[0] / 10u % fields.size()];
  if (choice[2] == choice[3]) return editor.set(node, field.name, field.defaultValue);
  Value value = node.get(field);
  std::visit([&](auto& stored) { changeAtPlaces(stored, choice[2], choice[3]); }, value);
  editor.set(node, field.name, std::move(value));
}

// Does one edit, which four bytes choose.
void editOnce(Editor& editor, World& world, std::array<uint8_t, bytesOfStep> choice, bool isXml,
              bool isJson) {
  const std::vector<Node*> nodes = nodesOf(world);
  if (nodes.empty()) return;
  const auto any = [&](uint8_t number) -> Node& { return *nodes[number % nodes.size()]; };
  const auto slot = [&](uint8_t number) -> NodeSlot {
    Node& parent = any(number);
    for (const FieldInfo& field : parent.type().fields)
      if (holdsValue(field) && (field.type == FieldType::MFNode || field.type == FieldType::SFNode))
        return {&parent, field.name, number % 3u};
    return {nullptr, "", number % (world.scope.roots.size() + 1)};
  };
  const std::string_view inserted = isJson  ? R"({"Group": {"@DEF": "N"}})"
                                    : isXml ? "<Group DEF='N'/>"
                                            : "DEF N Group { }";
  Node& node = any(choice[1]);
  switch (choice[0] % 10) {
  case 0: return setField(editor, node, choice);
  case 1: editor.insert(slot(choice[2]), inserted); return;
  case 2: return editor.remove(slot(choice[2]));
  case 3: return editor.move(slot(choice[2]), slot(choice[3]));
  case 4: return editor.use(slot(choice[2]), node);
  case 5: editor.wrap(slot(choice[2])); return;
  case 6: editor.duplicate(slot(choice[2])); return;
  case 7: editor.separate(slot(choice[2])); return;
  case 8: return editor.rename(node, "R" + std::to_string(choice[2]));
  default: editor.undo();
  }
}

void expectUndone(Editor& editor, const std::string& before) {
  std::string after;
  try {
    while (editor.undo()) {}
    after = editor.text();
  } catch (const EditError& error) { after = error.what(); }
  if (after == before) return;
  std::fprintf(stderr, "undo does not give the file back: %s\n", after.c_str());
  std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t head = 1 + steps * bytesOfStep;
  if (size <= head) return 0;
  constexpr std::array<const char*, 4> suffixes = {".wrl", ".x3dv", ".x3d", ".x3dj"};
  const size_t encoding = data[0] % suffixes.size();
  static const std::string folder = std::filesystem::temp_directory_path().string();
  const std::string path = folder + "/fuzz_edit_" + std::to_string(::getpid()) + suffixes[encoding];
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data) + head, std::streamsize(size - head));
  std::array<std::array<uint8_t, bytesOfStep>, steps> choices;
  for (size_t i = 0; i < steps; ++i)
    std::copy_n(data + 1 + i * bytesOfStep, bytesOfStep, choices[i].begin());
  try {
    const auto world = loadWorld(path, fuzzOptions());
    Editor editor(*world);
    if (editor.whyReadOnly().empty()) {
      const std::string before = editor.text();
      for (size_t i = 0; i < steps; ++i) try {
          editOnce(editor, *world, choices[i], encoding == 2, encoding == 3);
        } catch (const EditError&) {} // it is refused
      try {
        editor.text();
      } catch (const EditError&) {} // the text would not be the world
      expectUndone(editor, before);
    }
  } catch (const LoadError&) {
  } catch (const EditError&) {} // the file itself is not what it was read as
  std::filesystem::remove(path);
  return 0;
}
