// bindings.cpp: which material or normal belongs to which corner, face or segment
// ("MaterialBinding", "IndexedFaceSet" and "IndexedLineSet" of the specification).
#include "parse/vrml1/shapes.h"

namespace xvrml::vrml1 {

bool isAbsent(const MFInt32& index) { return index.empty() || (index.size() == 1 && index[0] < 0); }

size_t faceCount(const MFInt32& coordIndex) {
  size_t count = 0;
  for (size_t i = 0; i < coordIndex.size(); ++i)
    count += coordIndex[i] >= 0 && (i + 1 == coordIndex.size() || coordIndex[i + 1] < 0);
  return count;
}

MFInt32 boundIndices(const MFInt32& coordIndex, const MFInt32& given, Binding binding) {
  MFInt32 result;
  const bool indexed = isIndexed(binding) && !isAbsent(given);
  if (binding == Binding::perVertex || binding == Binding::perVertexIndexed) {
    if (binding == Binding::perVertexIndexed && !indexed) return coordIndex;
    result.reserve(coordIndex.size());
    int32_t corner = 0;
    for (size_t i = 0; i < coordIndex.size(); ++i) {
      if (coordIndex[i] < 0)
        result.push_back(-1);
      else if (indexed)
        result.push_back(i < given.size() && given[i] >= 0 ? given[i] : 0);
      else
        result.push_back(corner++);
    }
    return result;
  }
  const size_t faces = faceCount(coordIndex);
  result.reserve(faces);
  size_t next = 0; // files also write -1 between the indices of faces
  for (size_t face = 0; face < faces; ++face) {
    if (binding == Binding::overall) {
      result.push_back(0);
    } else if (!indexed) {
      result.push_back(static_cast<int32_t>(face));
    } else {
      while (next < given.size() && given[next] < 0) ++next;
      result.push_back(next < given.size() ? given[next++] : 0);
    }
  }
  return result;
}

Binding Shapes::binding(State& state, Slot slot, Binding ifDefault) {
  static const std::pair<std::string_view, Binding> names[] = {
      {"OVERALL", Binding::overall},
      {"PER_PART", Binding::perPart},
      {"PER_PART_INDEXED", Binding::perPartIndexed},
      {"PER_FACE", Binding::perFace},
      {"PER_FACE_INDEXED", Binding::perFaceIndexed},
      {"PER_VERTEX", Binding::perVertex},
      {"PER_VERTEX_INDEXED", Binding::perVertexIndexed}};
  const TreeNode* node = state.node(slot);
  if (!node) return ifDefault;
  const std::string& value = node->get<SFString>("value");
  if (value == "DEFAULT" || value == "NONE") return ifDefault; // NONE is Open Inventor's
  for (const auto& [name, binding] : names)
    if (name == value) return binding;
  graph_.warnOnce(*node, "binding " + value,
                  "'" + value + "' is no binding; DEFAULT is used instead");
  return ifDefault;
}

// Returns the materials of a shape, whose binding is not `overall`. Indices beyond the end of the
// material's lists begin again.
Shapes::Indices Shapes::materials(State& state, const MFInt32& coordIndex,
                                  const MFInt32& materialIndex, Binding binding) {
  Indices result;
  result.values = boundIndices(coordIndex, materialIndex, binding);
  result.perCorner = binding == Binding::perVertex || binding == Binding::perVertexIndexed;
  const auto count = static_cast<int32_t>(std::min<size_t>(looks_.list(state).count, INT32_MAX));
  for (int32_t& index : result.values)
    if (index >= count) index %= count;
  return result;
}

} // namespace xvrml::vrml1
