// edit_memory.cpp: edits leave no memory behind. After many edits the acceleration structures hold
// as much as after the first.
#include "numeric/support.h"

namespace numeric {
namespace {

using EditMemory = Scene;

void patch(RTid object, int n) {
  rtBeginObject(object);
  rtBegin(RT_TRIANGLES);
  for (int i = 0; i < n; i++) {
    rtVertex3d(i, 0, 0);
    rtVertex3d(i + 1, 0, 0);
    rtVertex3d(i, 1, i % 3);
  }
  rtEnd();
  rtSphere(2);
  rtEndObject();
}

TEST_F(EditMemory, NothingIsLeftBehind) {
  RTid objects[2];
  rtGenObjects(2, objects);
  rtObjectHint(objects[1], RT_DYNAMIC);
  for (RTid object : objects) patch(object, 200);
  RTid moving[3];
  for (RTid& id : moving) {
    id = rtInstantiateObject(objects[0]);
    rtInstanceHint(id, RT_DYNAMIC);
    rtInstantiateObject(objects[1]);
  }
  place(square(0));
  const auto round = [&](int i) {
    const double s = 1 + i % 2;
    const double m[16] = {s, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, double(i % 7), 1, 0, 1};
    rtInstanceMatrix(moving[i % 3], m);
    rtInstanceVisible(moving[(i + 1) % 3], i % 2);
    patch(objects[1], 200);
    look(i % 5); // renders
    const RTid extra = rtInstantiateObject(objects[0]);
    rtInstanceHint(extra, RT_DYNAMIC);
    rtRender();
    rtDeleteInstance(extra);
    rtRender();
  };
  for (int i = 0; i < 6; i++) round(i);
  const uint64_t bytes = stats().bvh.bytes;
  EXPECT_GT(bytes, 10000u);
  for (int i = 0; i < 60; i++) round(i);
  EXPECT_LE(stats().bvh.bytes, bytes + bytes / 10);
  for (RTid object : objects) rtDeleteObject(object);
  look();
  EXPECT_LT(stats().bvh.bytes, bytes / 2);
}

} // namespace
} // namespace numeric
