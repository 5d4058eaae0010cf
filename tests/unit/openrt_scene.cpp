// openrt_scene.cpp: from commits to a scene, from nested instances to placements.
#include <gtest/gtest.h>

#include "scene/flatten.h"

using namespace openrt;

namespace {

template <class T> void put(Commit& commit, T edit) {
  auto e = std::make_unique<edit::EditT>();
  e->any.Set(std::move(edit));
  commit.edits.edits.push_back(std::move(e));
}

edit::ObjectT object(uint32_t id, bool withGeometry) {
  edit::ObjectT o;
  o.id = id;
  if (withGeometry) {
    auto g = std::make_unique<edit::GeometryT>();
    g->primitive = edit::Primitive::Sphere;
    g->width = 1;
    o.geometries.push_back(std::move(g));
  }
  return o;
}

edit::InstanceT instance(uint32_t id, uint32_t parent, uint32_t object, double x = 0,
                         double scale = 1) {
  edit::InstanceT i;
  i.id = id;
  i.parent = parent;
  i.object = object;
  const double m[16] = {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, x, 0, 0, 1};
  i.matrix = std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(m));
  return i;
}

} // namespace

TEST(Flatten, nestedMatricesMultiplyFromTheOutside) {
  Commit commit;
  put(commit, object(1, true));
  put(commit, object(2, false));
  put(commit, instance(10, 2, 1, 3));
  put(commit, instance(11, 0, 2, 5, 2));
  Scene scene;
  scene.apply(commit);
  const Flattened flat = flatten(scene);
  ASSERT_EQ(flat.parts[0].items.size(), 1u);
  EXPECT_EQ(flat.parts[0].items[0].path.instance, 11u);
  EXPECT_DOUBLE_EQ(flat.parts[0].items[0].matrix.m[12], 5 + 2 * 3);
  EXPECT_DOUBLE_EQ(flat.parts[0].items[0].matrix.m[0], 2);
}

TEST(Flatten, singularPlacementsAreCountedAndDrawNothing) {
  Commit commit;
  put(commit, object(1, true));
  put(commit, instance(10, 0, 1, 0, 0));
  put(commit, instance(11, 0, 1, 0, 1e-20));
  put(commit, instance(12, 0, 1, 0, 1));
  Scene scene;
  scene.apply(commit);
  const Flattened flat = flatten(scene);
  EXPECT_EQ(flat.parts[0].items.size(), 1u);
  EXPECT_EQ(flat.rejected, 2u);
}

TEST(Flatten, outermostShaderAndInnermostUserData) {
  Commit commit;
  put(commit, object(1, true));
  put(commit, object(2, false));
  auto inner = instance(10, 2, 1), outer = instance(11, 0, 2);
  inner.shader = 7;
  outer.shader = 8;
  inner.userData = 70;
  outer.userData = 80;
  put(commit, std::move(inner));
  put(commit, std::move(outer));
  Scene scene;
  scene.apply(commit);
  const Flattened flat = flatten(scene);
  ASSERT_EQ(flat.parts[0].items.size(), 1u);
  EXPECT_EQ(flat.parts[0].items[0].path.shader, 8u);
  EXPECT_EQ(flat.parts[0].items[0].path.userData, 70u);
}

TEST(Flatten, aTowerOfEmptyDoublingsCostsNothing) {
  Commit commit;
  for (uint32_t i = 1; i <= 60; i++) put(commit, object(i, false));
  for (uint32_t i = 1; i < 60; i++) {
    put(commit, instance(100 + 2 * i, i, i + 1));
    put(commit, instance(101 + 2 * i, i, i + 1));
  }
  put(commit, instance(500, 0, 1));
  Scene scene;
  scene.apply(commit);
  EXPECT_TRUE(flatten(scene).parts[0].items.empty());
}

TEST(Flatten, nestingDeepCostsNoCallStack) {
  Commit commit;
  const uint32_t depth = 100000;
  for (uint32_t i = 1; i <= depth; i++) put(commit, object(i, i == depth));
  for (uint32_t i = 1; i < depth; i++) put(commit, instance(depth + i, i, i + 1, 1));
  put(commit, instance(3 * depth, 0, 1));
  Scene scene;
  scene.apply(commit);
  const Flattened flat = flatten(scene);
  ASSERT_EQ(flat.parts[0].items.size(), 1u);
  EXPECT_DOUBLE_EQ(flat.parts[0].items[0].matrix.m[12], depth - 1);
}

TEST(Flatten, scopedLightsShineBelowTheirInstanceOnly) {
  Commit commit;
  put(commit, object(1, true));
  put(commit, instance(10, 0, 1));
  put(commit, instance(11, 0, 1));
  edit::LightT all, some;
  all.id = 20;
  some.id = 21;
  some.scope = 11;
  put(commit, std::move(all));
  put(commit, std::move(some));
  Scene scene;
  scene.apply(commit);
  const Flattened flat = flatten(scene);
  ASSERT_EQ(flat.parts[0].items.size(), 2u);
  EXPECT_EQ(flat.lightSets[flat.parts[0].items[0].path.lightSet], std::vector<uint32_t>{20});
  EXPECT_EQ(flat.lightSets[flat.parts[0].items[1].path.lightSet], (std::vector<uint32_t>{20, 21}));
}

TEST(Scene, redefiningAnObjectDropsItsChildren) {
  Commit first, second;
  put(first, object(1, true));
  put(first, object(2, false));
  put(first, instance(10, 2, 1));
  put(first, instance(11, 0, 2));
  Scene scene;
  scene.apply(first);
  EXPECT_EQ(flatten(scene).parts[0].items.size(), 1u);
  put(second, object(2, false));
  scene.apply(second);
  EXPECT_EQ(flatten(scene).parts[0].items.size(), 0u);
  EXPECT_EQ(scene.instances.size(), 1u);
}
