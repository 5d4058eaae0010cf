// openrt_api_hints.cpp: the edits mark objects and instances as static or dynamic: by hint, and
// automatically once a committed one is moved or redefined. Backends created later and recordings
// see the same state.
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

class Hints : public ApiTest {
 protected:
  const double matrix[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1};

  // Returns the flags in the next commit's edits, in order.
  std::vector<bool> instanceFlags() {
    std::vector<bool> flags;
    for (const auto* e : edits<edit::InstanceT>(commit())) flags.push_back(e->dynamic);
    return flags;
  }
  std::vector<bool> objectFlags() {
    std::vector<bool> flags;
    for (const auto* e : edits<edit::ObjectT>(commit())) flags.push_back(e->dynamic);
    return flags;
  }
  void redefine(RTid object) {
    rtBeginObject(object);
    rtSphere(1);
    rtEndObject();
  }
};

using Flags = std::vector<bool>;

TEST_F(Hints, WhatWasNeverCommittedStaysStatic) {
  const RTid object = triangleObject(), instance = rtInstantiateObject(object);
  rtInstanceMatrix(instance, matrix);
  rtInstanceVisible(instance, 0);
  redefine(object);
  const Commit& c = commit();
  EXPECT_FALSE(edits<edit::InstanceT>(c).at(0)->dynamic);
  EXPECT_FALSE(edits<edit::ObjectT>(c).at(0)->dynamic);
}

TEST_F(Hints, AMovedInstanceIsDynamicFromThenOn) {
  const RTid instance = rtInstantiateObject(triangleObject());
  EXPECT_EQ(instanceFlags(), Flags{false});
  rtInstanceMatrix(instance, matrix);
  EXPECT_EQ(instanceFlags(), Flags{true});
  rtInstanceUserData(instance, 7);
  EXPECT_EQ(instanceFlags(), Flags{true});
}

TEST_F(Hints, AHiddenInstanceIsDynamicFromThenOn) {
  const RTid instance = rtInstantiateObject(triangleObject());
  commit();
  rtInstanceVisible(instance, 0);
  EXPECT_EQ(instanceFlags(), Flags{true});
}

TEST_F(Hints, WhatStaysWhereItIsSendsNothing) {
  const RTid instance = rtInstantiateObject(triangleObject());
  rtInstanceMatrix(instance, matrix);
  commit();
  rtInstanceMatrix(instance, matrix);
  rtInstanceVisible(instance, 2);
  EXPECT_TRUE(commit().edits.edits.empty());
}

TEST_F(Hints, ShaderAndUserDataMakeNothingDynamic) {
  const RTid instance = rtInstantiateObject(triangleObject());
  commit();
  rtInstanceShader(instance, 0);
  rtInstanceUserData(instance, 3);
  EXPECT_EQ(instanceFlags(), Flags{false});
}

TEST_F(Hints, ARedefinedObjectIsDynamicFromThenOn) {
  const RTid object = triangleObject();
  EXPECT_EQ(objectFlags(), Flags{false});
  redefine(object);
  EXPECT_EQ(objectFlags(), Flags{true});
}

TEST_F(Hints, AHintHolds) {
  const RTid object = triangleObject();
  rtObjectHint(object, RT_DYNAMIC);
  const RTid instance = rtInstantiateObject(object);
  rtInstanceHint(instance, RT_DYNAMIC);
  const Commit& c = commit();
  EXPECT_TRUE(edits<edit::InstanceT>(c).at(0)->dynamic);
  EXPECT_TRUE(edits<edit::ObjectT>(c).at(0)->dynamic);
  rtInstanceHint(instance, RT_STATIC);
  EXPECT_EQ(instanceFlags(), Flags{false});
  rtInstanceMatrix(instance, matrix); // it is moved although hinted static
  EXPECT_EQ(instanceFlags(), Flags{true});
}

TEST_F(Hints, BadHintsAreErrors) {
  const RTid object = triangleObject(), instance = rtInstantiateObject(object);
  EXPECT_FAILS(RT_INVALID_ENUM, rtInstanceHint(instance, 17));
  EXPECT_FAILS(RT_INVALID_ENUM, rtObjectHint(object, 17));
  EXPECT_FAILS(RT_INVALID_ID, rtInstanceHint(object, RT_STATIC));
  EXPECT_FAILS(RT_INVALID_ID, rtObjectHint(instance, RT_STATIC));
}

} // namespace
