// same_bytes.h: compares the results of vector code between the instruction sets of this machine.
#pragma once

#include <cstring>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace openrt::test {

// Calls `compute` with each instruction set. It appends its results; they must have the same bytes.
inline void expectSameBytes(const std::function<void(std::vector<float>&)>& compute) {
  std::vector<float> first;
  int sets = 0;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::vector<float> results;
    compute(results);
    if (sets++ == 0) first = results;
    ASSERT_EQ(results.size(), first.size());
    EXPECT_EQ(std::memcmp(results.data(), first.data(), first.size() * sizeof(float)), 0)
        << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(sets, 1);
}

} // namespace openrt::test
