// openrt_api_objects.cpp: objects, instances, nesting, deletion, and the edits in a commit.
#include <algorithm>
#include <cmath>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

class Objects : public ApiTest {
 protected:
  // Defines an object that contains these objects.
  RTid groupOf(std::initializer_list<RTid> objects, RTid id = 0) {
    const RTid group = rtBeginObject(id);
    for (RTid object : objects) lastChild = rtInstantiateObject(object);
    rtEndObject();
    return group;
  }
  RTid lastChild = 0;
  const double matrix[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1};
};

TEST_F(Objects, GenMakesEmptyObjects) {
  RTid ids[3] = {};
  rtGenObjects(3, ids);
  EXPECT_TRUE(ids[0] && ids[1] && ids[2] && ids[0] != ids[1] && ids[1] != ids[2]);
  rtGenObjects(0, nullptr);
  EXPECT_NE(rtInstantiateObject(ids[1]), 0u);
  const Commit& c = commit();
  ASSERT_EQ(edits<edit::ObjectT>(c).size(), 3u);
  EXPECT_TRUE(edits<edit::ObjectT>(c)[1]->geometries.empty());
  EXPECT_FAILS(RT_INVALID_VALUE, rtGenObjects(1, nullptr));
}

TEST_F(Objects, AnInstanceLatchesMatrixAndName) {
  const RTid object = triangleObject();
  rtTranslated(1, 2, 3);
  rtLoadName(5);
  const RTid instance = rtInstantiateObject(object);
  rtLoadIdentity();
  const Commit& c = commit();
  const auto found = edits<edit::InstanceT>(c);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]->id, instance);
  EXPECT_EQ(found[0]->object, object);
  EXPECT_EQ(found[0]->parent, 0u);
  EXPECT_EQ(found[0]->name, 5u);
  EXPECT_TRUE(found[0]->visible);
  EXPECT_EQ(matrixOf(*found[0]->matrix)[13], 2.0);
}

TEST_F(Objects, TheLatestStateIsSentOnce) {
  const RTid instance = rtInstantiateObject(triangleObject());
  commit();
  double m[16];
  std::copy(matrix, matrix + 16, m);
  for (int i = 0; i < 100; i++) {
    m[12] = i;
    rtInstanceMatrix(instance, m);
  }
  rtInstanceVisible(instance, 0);
  rtInstanceUserData(instance, uint64_t(1) << 40);
  const Commit& c = commit();
  ASSERT_EQ(c.edits.edits.size(), 1u);
  const edit::InstanceT& e = *edits<edit::InstanceT>(c).at(0);
  EXPECT_EQ(matrixOf(*e.matrix)[12], 99.0);
  EXPECT_FALSE(e.visible);
  EXPECT_EQ(e.userData, uint64_t(1) << 40);
  EXPECT_TRUE(commit().edits.edits.empty());
}

TEST_F(Objects, RedefiningReplacesGeometryAndChildren) {
  const RTid leaf = triangleObject();
  const RTid group = groupOf({leaf, leaf});
  const RTid old = lastChild;
  commit();
  rtBeginObject(group);
  rtSphere(1);
  const RTid fresh = rtInstantiateObject(leaf);
  rtInstanceMatrix(old, matrix); // the old instance exists until the definition ends
  EXPECT_RT_ERROR(RT_NO_ERROR);
  rtEndObject();
  EXPECT_FAILS(RT_INVALID_ID, rtInstanceMatrix(old, matrix));
  const Commit& c = commit();
  EXPECT_EQ(edits<edit::DeleteInstanceT>(c).size(), 2u);
  ASSERT_EQ(edits<edit::ObjectT>(c).size(), 1u);
  EXPECT_EQ(edits<edit::ObjectT>(c)[0]->geometries.size(), 1u);
  ASSERT_EQ(edits<edit::InstanceT>(c).size(), 1u);
  EXPECT_EQ(edits<edit::InstanceT>(c)[0]->id, fresh);
  EXPECT_EQ(edits<edit::InstanceT>(c)[0]->parent, group);
}

TEST_F(Objects, RedefinedBeforeACommitOnlyTheLastIsSent) {
  const RTid object = triangleObject();
  rtBeginObject(object);
  rtSphere(2);
  rtEndObject();
  const Commit& c = commit();
  ASSERT_EQ(edits<edit::ObjectT>(c).size(), 1u);
  EXPECT_EQ(edits<edit::ObjectT>(c)[0]->geometries.at(0)->primitive, edit::Primitive::Sphere);
  EXPECT_TRUE(c.arrays.empty());
}

TEST_F(Objects, NoObjectContainsItself) {
  const RTid a = triangleObject(), b = groupOf({a}), c = groupOf({b, a});
  rtBeginObject(a);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInstantiateObject(a));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInstantiateObject(b));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInstantiateObject(c));
  rtEndObject();
  groupOf({}, b); // b no longer contains a
  rtBeginObject(a);
  EXPECT_NE(rtInstantiateObject(b), 0u);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInstantiateObject(c)); // still contains a itself
  rtEndObject();
  commit();
}

// "a contains b" becomes "b contains a" within one commit. The deletion comes first, so no edit
// creates a cycle.
TEST_F(Objects, NestingMayBeTurnedRound) {
  const RTid b = triangleObject(), a = groupOf({b});
  commit();
  groupOf({}, a);
  groupOf({a}, b);
  commit(); // the capturing backend checks nesting
  rtDeleteInstance(lastChild);
  groupOf({b}, a);
  commit();
}

TEST_F(Objects, DeepNesting) {
  RTid object = triangleObject();
  for (int i = 0; i < 20000; i++) object = groupOf({object});
  rtInstantiateObject(object);
  EXPECT_EQ(edits<edit::InstanceT>(commit()).size(), 20001u);
}

TEST_F(Objects, DeletingAnObjectTakesItsInstances) {
  const RTid leaf = triangleObject(), group = groupOf({leaf});
  const RTid inGroup = lastChild, inScene = rtInstantiateObject(leaf),
             other = rtInstantiateObject(group);
  commit();
  rtDeleteObject(leaf);
  EXPECT_FAILS(RT_INVALID_ID, rtInstantiateObject(leaf));
  EXPECT_FAILS(RT_INVALID_ID, rtInstanceMatrix(inGroup, matrix));
  EXPECT_FAILS(RT_INVALID_ID, rtInstanceMatrix(inScene, matrix));
  rtInstanceMatrix(other, matrix);
  const Commit& c = commit();
  EXPECT_EQ(edits<edit::DeleteInstanceT>(c).size(), 2u);
  EXPECT_EQ(edits<edit::DeleteObjectT>(c).size(), 1u);
  EXPECT_EQ(edits<edit::InstanceT>(c).size(), 1u);
  EXPECT_EQ(c.edits.edits.back()->any.type, edit::Any::DeleteObject);
  rtDeleteObject(group);
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteInstance(other));
  commit();
}

TEST_F(Objects, WhatWasNeverCommittedLeavesNoTrace) {
  const RTid object = triangleObject();
  const RTid instance = rtInstantiateObject(object);
  rtDeleteInstance(instance);
  rtDeleteObject(object);
  const Commit& c = commit();
  EXPECT_EQ(c.edits.edits.size(), 1u); // only the frame settings
  EXPECT_TRUE(c.arrays.empty());
}

TEST_F(Objects, DeletionWithinAnOpenDefinition) {
  const RTid leaf = triangleObject(), other = triangleObject();
  const RTid group = rtBeginObject(0);
  const RTid first = rtInstantiateObject(leaf);
  const RTid second = rtInstantiateObject(other);
  rtInstantiateObject(other);
  rtDeleteInstance(first);
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteInstance(first));
  rtDeleteObject(leaf);
  rtInstanceMatrix(second, matrix);
  rtEndObject();
  const Commit& c = commit();
  const auto placed = edits<edit::InstanceT>(c);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_TRUE(std::all_of(placed.begin(), placed.end(),
                          [&](const auto* i) { return i->parent == group && i->object == other; }));
}

TEST_F(Objects, ManyDeletionsInAnyOrder) {
  const RTid leaf = triangleObject();
  const RTid group = rtBeginObject(0);
  std::vector<RTid> ids;
  for (int i = 0; i < 200; i++) ids.push_back(rtInstantiateObject(leaf));
  rtEndObject();
  commit();
  for (int i = 0; i < 200; i++) rtDeleteInstance(ids[(i * 77) % 200]);
  EXPECT_EQ(edits<edit::DeleteInstanceT>(commit()).size(), 200u);
  rtDeleteObject(group);
  rtDeleteObject(leaf);
  commit();
}

TEST_F(Objects, BadIdsAreErrors) {
  const RTid object = triangleObject(), instance = rtInstantiateObject(object);
  for (RTid bad : {RTid(0), RTid(123456), instance})
    EXPECT_FAILS(RT_INVALID_ID, rtInstantiateObject(bad));
  for (RTid bad : {RTid(0), RTid(123456), object}) {
    EXPECT_FAILS(RT_INVALID_ID, rtDeleteInstance(bad));
    EXPECT_FAILS(RT_INVALID_ID, rtInstanceMatrix(bad, matrix));
    EXPECT_FAILS(RT_INVALID_ID, rtInstanceVisible(bad, 1));
    EXPECT_FAILS(RT_INVALID_ID, rtInstanceShader(bad, 0));
    EXPECT_FAILS(RT_INVALID_ID, rtInstanceUserData(bad, 1));
  }
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteObject(instance));
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteObject(0));
  EXPECT_FAILS(RT_INVALID_ID, rtBeginObject(instance));
  EXPECT_FAILS(RT_INVALID_ID, rtBeginObject(123456));
  EXPECT_FAILS(RT_INVALID_ID, rtInstanceShader(instance, object));
}

TEST_F(Objects, ABadMatrixLeavesTheInstanceAlone) {
  const RTid instance = rtInstantiateObject(triangleObject());
  commit();
  double bad[16];
  std::copy(matrix, matrix + 16, bad);
  bad[0] = std::nan("");
  EXPECT_FAILS(RT_INVALID_VALUE, rtInstanceMatrix(instance, bad));
  bad[0] = 1;
  bad[15] = 2;
  EXPECT_FAILS(RT_INVALID_VALUE, rtInstanceMatrix(instance, bad));
  EXPECT_FAILS(RT_INVALID_VALUE, rtInstanceMatrix(instance, nullptr));
  EXPECT_TRUE(commit().edits.edits.empty());
  bad[15] = 1;
  bad[0] = 0; // singular: nothing is drawn
  rtInstanceMatrix(instance, bad);
  EXPECT_EQ(commit().edits.edits.size(), 1u);
}

TEST_F(Objects, ACommitThatFailsIsOfferedAgain) {
  const RTid instance = rtInstantiateObject(triangleObject());
  captured->failNextApply = true;
  EXPECT_FAILS(RT_OUT_OF_MEMORY, rtRender());
  EXPECT_TRUE(captured->commits.empty());
  rtInstanceVisible(instance, 0);
  rtRender();
  ASSERT_EQ(captured->commits.size(), 2u);
  EXPECT_EQ(edits<edit::ObjectT>(*captured->commits[0]).size(), 1u);
  EXPECT_EQ(edits<edit::InstanceT>(*captured->commits[1]).size(), 1u);
}

} // namespace
