// openrt_array_blocks.cpp: small arrays that share blocks of memory.
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "scene/array_blocks.h"

namespace openrt {
namespace {

ArrayPtr arrayOf(size_t bytes, uint8_t value) {
  auto array = std::make_shared<Array>(bytes);
  std::memset(array->data(), value, bytes);
  return array;
}

TEST(ArrayBlocks, CopiesHaveTheBytesAndOutliveTheBlocks) {
  std::vector<ArrayPtr> copies;
  {
    ArrayBlocks blocks;
    for (size_t i = 0; i < 1000; i++)
      copies.push_back(blocks.copy(*arrayOf(i % ArrayBlocks::largestBytes, uint8_t(i))));
  }
  for (size_t i = 0; i < copies.size(); i++) {
    EXPECT_TRUE(sameBytes(copies[i], arrayOf(i % ArrayBlocks::largestBytes, uint8_t(i)))) << i;
    EXPECT_EQ(reinterpret_cast<uintptr_t>(copies[i]->data()) % 16, 0u);
  }
  // One that stays keeps its bytes when its neighbours go.
  const ArrayPtr last = copies.back();
  copies.clear();
  EXPECT_TRUE(sameBytes(last, arrayOf(999, uint8_t(999))));
}

TEST(ArrayBlocks, NeighboursDoNotOverlapAndMayBeReadBeyondTheirEnd) {
  ArrayBlocks blocks;
  const ArrayPtr first = blocks.copy(*arrayOf(100, 1)), second = blocks.copy(*arrayOf(100, 2));
  EXPECT_GE(second->data(), first->data() + 100);
  unsigned sum = 0;
  for (size_t i = 0; i < 64; i++) sum += unsigned(second->data()[100 + i]); // the sanitizer checks
  EXPECT_EQ(sum, 0u);
}

} // namespace
} // namespace openrt
