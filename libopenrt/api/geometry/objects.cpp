// objects.cpp: Implements the API functions that define objects and place instances. Runs on the
// application's thread.
#include "api/geometry/transform.h"
#include "api/guard.h"

using namespace openrt;

namespace {

// Marks an instance for the next commit and changes it.
template <class Change> void changeInstance(Context& c, RTid id, const Change& change) {
  InstanceState& state = c.scene.instance(id);
  c.scene.instances.markDirty(id, state);
  change(state);
}

// Changes the matrix or the visibility of an instance. An instance that was already committed
// becomes dynamic (openrt.h, rtInstanceHint). The flag is part of its edit, so every backend and
// every recording builds the same acceleration structure.
template <class T>
void placeInstance(Context& c, RTid id, T InstanceState::*member, const T& value) {
  InstanceState& state = c.scene.instance(id);
  if (state.*member == value) return;
  c.scene.instances.markDirty(id, state);
  if (state.committed) state.dynamic = true;
  state.*member = value;
}

bool isDynamic(RTenum hint) {
  require(hint == RT_STATIC || hint == RT_DYNAMIC, RT_INVALID_ENUM,
          "the hint is neither RT_STATIC nor RT_DYNAMIC");
  return hint == RT_DYNAMIC;
}

RTid beginObject(Context& c, RTid id) {
  c.requireOutsideDefinition();
  if (id != 0) c.scene.object(id);
  const RTid object = id != 0 ? id : c.scene.newObject();
  c.matrices.openDefinition();
  c.definition.emplace();
  c.definition->object = object;
  c.definition->formerIndices = c.scene.restingIndices(object);
  return object;
}

void endObject(Context& c) {
  Definition& definition = c.openDefinition();
  c.requireOutsideList();
  c.matrices.checkBalanced();
  c.scene.defineObject(definition.object, definition.builder.finish(), definition.children);
  c.degenerate += definition.builder.degenerate();
  c.matrices.closeDefinition();
  c.definition.reset();
}

RTid instantiate(Context& c, RTid object) {
  c.scene.object(object);
  c.requireOutsideList();
  InstanceState state;
  state.object = object;
  state.name = c.name;
  state.matrix = c.matrices.top();
  if (!c.definition) return c.scene.newInstance(state);
  std::vector<RTid>& siblings = c.definition->children;
  require(!c.scene.contains(object, c.definition->object), RT_INVALID_OPERATION,
          "the object would contain itself");
  state.parent = c.definition->object;
  state.inDefinition = true;
  state.childSlot = siblings.size();
  siblings.push_back(0);
  try {
    return siblings.back() = c.scene.newInstance(state);
  } catch (...) {
    siblings.pop_back();
    throw;
  }
}

} // namespace

void rtGenObjects(size_t count, RTid* ids) {
  guarded("rtGenObjects", [&](Context& c) {
    require(ids || count == 0, RT_INVALID_VALUE, "the pointer is NULL");
    for (size_t i = 0; i < count; i++) ids[i] = c.scene.newObject();
  });
}

RTid rtBeginObject(RTid id) {
  return guarded("rtBeginObject", RTid(0), [&](Context& c) { return beginObject(c, id); });
}

void rtEndObject(void) { guarded("rtEndObject", endObject); }

void rtDeleteObject(RTid object) {
  guarded("rtDeleteObject", [&](Context& c) {
    c.scene.object(object);
    require(!c.definition || c.definition->object != object, RT_INVALID_OPERATION,
            "this object is being defined");
    c.scene.deleteObject(object, c.openChildren());
  });
}

RTid rtInstantiateObject(RTid object) {
  return guarded("rtInstantiateObject", RTid(0),
                 [&](Context& c) { return instantiate(c, object); });
}

void rtDeleteInstance(RTid instance) {
  guarded("rtDeleteInstance",
          [&](Context& c) { c.scene.deleteInstance(instance, c.openChildren()); });
}

void rtInstanceMatrix(RTid instance, const double m[16]) {
  guarded("rtInstanceMatrix", [&](Context& c) {
    const Matrix4d matrix = checkedMatrix(m);
    placeInstance(c, instance, &InstanceState::matrix, matrix);
  });
}

void rtInstanceVisible(RTid instance, int visible) {
  guarded("rtInstanceVisible",
          [&](Context& c) { placeInstance(c, instance, &InstanceState::visible, visible != 0); });
}

void rtInstanceShader(RTid instance, RTid shader) {
  guarded("rtInstanceShader", [&](Context& c) {
    c.scene.requireKind(shader, RTS_SURFACE);
    changeInstance(c, instance, [&](InstanceState& s) { s.shader = shader; });
  });
}

void rtInstanceFog(RTid instance, RTid shader) {
  guarded("rtInstanceFog", [&](Context& c) {
    c.scene.requireKind(shader, RTS_ENVIRONMENT);
    changeInstance(c, instance, [&](InstanceState& s) { s.fog = shader; });
  });
}

void rtInstanceHint(RTid instance, RTenum hint) {
  guarded("rtInstanceHint", [&](Context& c) {
    const bool dynamic = isDynamic(hint);
    changeInstance(c, instance, [&](InstanceState& s) { s.dynamic = dynamic; });
  });
}

void rtObjectHint(RTid object, RTenum hint) {
  guarded("rtObjectHint", [&](Context& c) { c.scene.object(object).dynamic = isDynamic(hint); });
}

void rtInstanceUserData(RTid instance, uint64_t data) {
  guarded("rtInstanceUserData", [&](Context& c) {
    changeInstance(c, instance, [&](InstanceState& s) { s.userData = data; });
  });
}
