// openrt_clusters.cpp: Tests cutting a scene at its dynamic parts into parts, sockets and clusters,
// and the changes that each commit reports.
#include <gtest/gtest.h>

#include "scene/flatten.h"

using namespace openrt;

namespace {

template <class T> void put(Commit& commit, T edit) {
  auto e = std::make_unique<edit::EditT>();
  e->any.Set(std::move(edit));
  commit.edits.edits.push_back(std::move(e));
}

edit::ObjectT object(uint32_t id, bool withGeometry, bool dynamic = false) {
  edit::ObjectT o;
  o.id = id;
  o.dynamic = dynamic;
  if (withGeometry) {
    auto g = std::make_unique<edit::GeometryT>();
    g->primitive = edit::Primitive::Sphere;
    g->width = 1;
    o.geometries.push_back(std::move(g));
  }
  return o;
}

edit::InstanceT instance(uint32_t id, uint32_t parent, uint32_t object, double x,
                         bool dynamic = false) {
  edit::InstanceT i;
  i.id = id;
  i.parent = parent;
  i.object = object;
  i.dynamic = dynamic;
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
  i.matrix = std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(m));
  return i;
}

template <class... Edits> SceneChanges apply(Scene& scene, Edits... edits) {
  Commit commit;
  (put(commit, std::move(edits)), ...);
  return scene.apply(commit);
}

using Ids = std::vector<uint32_t>;

} // namespace

TEST(Clusters, WithoutDynamicThingsThereIsOne) {
  Scene scene;
  apply(scene, object(1, true), instance(10, 0, 1, 0), instance(11, 0, 1, 2));
  const Flattened flat = flatten(scene);
  EXPECT_EQ(flat.parts.size(), 1u);
  EXPECT_EQ(flat.clusters.size(), 1u);
  EXPECT_EQ(flat.parts[0].items.size(), 2u);
}

TEST(Clusters, CopiesOfOneObjectAreOnePart) {
  Scene scene;
  apply(scene, object(1, true), instance(10, 0, 1, 1, true), instance(11, 0, 1, 2, true),
        instance(12, 0, 1, 3));
  const Flattened flat = flatten(scene);
  ASSERT_EQ(flat.parts.size(), 2u);
  EXPECT_EQ(flat.parts[0].items.size(), 1u);
  EXPECT_EQ(flat.parts[1].items.size(), 1u);
  ASSERT_EQ(flat.clusters.size(), 3u);
  EXPECT_EQ(flat.clusters[2].world.m[12], 2);
  EXPECT_EQ(flat.clusters[2].path.instance, 11u);
}

// A dynamic instance in an object with two instances, one of them dynamic, makes a cluster for
// every path.
TEST(Clusters, OneForEveryPath) {
  Scene scene;
  apply(scene, object(1, true), object(2, true), instance(10, 2, 1, 1, true),
        instance(11, 0, 2, 10), instance(12, 0, 2, 20, true));
  Flattened flat = flatten(scene);
  ASSERT_EQ(flat.clusters.size(), 4u);
  Ids places;
  for (const Cluster& c : flat.clusters) places.push_back(uint32_t(c.world.m[12]));
  EXPECT_EQ(places, (Ids{0, 11, 20, 21}));
  // The outer instance moves, and the one below it is hidden.
  EXPECT_EQ(apply(scene, instance(12, 0, 2, 30, true)).moved, Ids{12});
  EXPECT_EQ(updateClusters(scene, flat, {12}), (Ids{2, 3}));
  EXPECT_EQ(flat.clusters[3].world.m[12], 31);
  apply(scene, instance(10, 2, 1, 5, true));
  EXPECT_EQ(updateClusters(scene, flat, {10, 12, 10}), (Ids{1, 2, 3}));
  EXPECT_EQ(flat.clusters[1].world.m[12], 15);
  EXPECT_EQ(flat.clusters[3].world.m[12], 35);
  auto hidden = instance(12, 0, 2, 30, true);
  hidden.visible = false;
  apply(scene, std::move(hidden));
  updateClusters(scene, flat, {12});
  EXPECT_TRUE(flat.clusters[1].visible);
  EXPECT_FALSE(flat.clusters[2].visible);
  EXPECT_FALSE(flat.clusters[3].visible);
}

TEST(Clusters, ADynamicObjectIsAPartWhereverItStands) {
  Scene scene;
  apply(scene, object(1, true, true), object(2, true), instance(10, 2, 1, 1),
        instance(11, 0, 2, 10), instance(12, 0, 1, 20));
  const Flattened flat = flatten(scene);
  EXPECT_EQ(flat.parts.size(), 2u);
  EXPECT_EQ(flat.clusters.size(), 3u);
}

TEST(Clusters, HiddenOnesAreThereStaticOnesAreNot) {
  Scene scene;
  auto moving = instance(10, 0, 1, 1, true), still = instance(11, 0, 1, 2);
  moving.visible = still.visible = false;
  apply(scene, object(1, true), std::move(moving), std::move(still));
  const Flattened flat = flatten(scene);
  EXPECT_TRUE(flat.parts[0].items.empty());
  ASSERT_EQ(flat.clusters.size(), 2u);
  EXPECT_FALSE(flat.clusters[1].visible);
}

TEST(Clusters, ATowerOfDynamicDoublingsIsCutOff) {
  Scene scene;
  Commit commit;
  const uint32_t levels = 30;
  for (uint32_t i = 1; i <= levels; i++) put(commit, object(i, i == levels));
  for (uint32_t i = 1; i < levels; i++) {
    put(commit, instance(100 + 2 * i, i, i + 1, 1, true));
    put(commit, instance(101 + 2 * i, i, i + 1, 2, true));
  }
  put(commit, instance(500, 0, 1, 0, true));
  scene.apply(commit);
  Flattened flat = flatten(scene);
  EXPECT_TRUE(flat.truncated);
  EXPECT_LE(flat.clusters.size(), maxClusters);
  apply(scene, instance(500, 0, 1, 7, true));
  EXPECT_EQ(updateClusters(scene, flat, {500}).size(), flat.clusters.size() - 1);
}

TEST(Changes, AreNamed) {
  Scene scene;
  SceneChanges c =
      apply(scene, object(1, true, true), instance(10, 0, 1, 1, true), instance(11, 0, 1, 2));
  EXPECT_TRUE(c.structure);
  c = apply(scene, instance(10, 0, 1, 5, true));
  EXPECT_FALSE(c.structure);
  EXPECT_EQ(c.moved, Ids{10});
  EXPECT_TRUE(apply(scene, instance(11, 0, 1, 5)).structure);
  EXPECT_TRUE(apply(scene, instance(11, 0, 1, 5, true)).structure); // becomes dynamic
  auto shaded = instance(10, 0, 1, 5, true);
  shaded.shader = 3;
  EXPECT_TRUE(apply(scene, std::move(shaded)).structure);
  c = apply(scene, object(1, true, true));
  EXPECT_FALSE(c.structure);
  EXPECT_EQ(c.redefined, Ids{1});
  EXPECT_TRUE(apply(scene, object(1, true, true), instance(12, 1, 1, 0)).structure);
  EXPECT_TRUE(apply(scene, object(1, true, true)).structure); // the object had an instance in it
}

TEST(Changes, ListsOfChildrenFollow) {
  Scene scene;
  apply(scene, object(1, true), object(2, false), instance(13, 2, 1, 0), instance(11, 2, 1, 0),
        instance(12, 0, 1, 0));
  EXPECT_EQ(scene.childrenOf(2), (Ids{11, 13}));
  edit::DeleteInstanceT gone;
  gone.id = 11;
  apply(scene, std::move(gone), instance(14, 2, 1, 0), instance(13, 2, 1, 4));
  EXPECT_EQ(scene.childrenOf(2), (Ids{13, 14}));
  EXPECT_EQ(scene.childrenOf(0), Ids{12});
  apply(scene, object(2, false), instance(15, 2, 1, 0));
  EXPECT_EQ(scene.childrenOf(2), Ids{15});
  EXPECT_FALSE(scene.instances.contains(13));
}
