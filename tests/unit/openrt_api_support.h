// openrt_api_support.h: a backend that keeps the commits it receives and validates each like the
// reader of recordings, a fixture with a context on that backend, and helpers to look into commits.
// Used by the tests of the C API.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "api/context.h"
#include "backend/queries.h"
#include "backend/record/validator.h"
#include "openrt/openrt.h"

namespace openrt::test {

struct Captured {
  explicit Captured(const std::string& plugins)
      : Captured(std::vector<std::string>{plugins + "/stock", plugins}) {}
  explicit Captured(std::vector<std::string> folders)
      : shaders(std::move(folders)), validator(&shaders) {}
  ShaderRegistry shaders;
  CommitValidator validator;
  std::vector<std::shared_ptr<const Commit>> commits;
  int starts = 0, waits = 0, cancels = 0;
  bool failNextApply = false, failNextWait = false, pipelines = false;
  std::string backendCalls;  // backend calls so far: a apply, s start, w wait, c cancel
  std::string cancelIn;      // letters of the calls during which rtCancel() is called
  std::function<void()> end; // called by the backend's destructor
};

// Finds something at every ray, but not in lists and counts.
class FakeQueries final : public Queries {
 public:
  void castRays(std::span<const RTray>, std::span<RThit> hits) override {
    for (RThit& hit : hits) hit.t = 7;
  }
  void occludedRays(std::span<const RTray>, std::span<uint8_t> occluded) override {
    for (uint8_t& o : occluded) o = 1;
  }
  bool pick(double, double, RThit& hit) override {
    hit.t = 7;
    return true;
  }
  void countHits(std::span<const RTray>, std::span<uint32_t> counts) override {
    for (uint32_t& count : counts) count = 0;
  }
  void listHits(std::span<const RTray>, std::span<const size_t>, std::span<RThit>) override {}
  void closestPoints(std::span<const float>, float, std::span<RTclosest>) override {}
  void castDouble(std::span<const RTrayd>, std::span<RThitd> hits) override {
    for (RThitd& hit : hits) hit.t = 7;
  }
  void occludeDouble(std::span<const RTrayd>, std::span<uint8_t> occluded) override {
    for (uint8_t& o : occluded) o = 1;
  }
  void countDouble(std::span<const RTrayd>, std::span<uint32_t> counts) override {
    for (uint32_t& count : counts) count = 0;
  }
  void listDouble(std::span<const RTrayd>, std::span<const size_t>, std::span<RThitd>) override {}
  void closestDouble(std::span<const double>, double, std::span<RThitd>) override {}
};

class CaptureBackend final : public Backend {
 public:
  explicit CaptureBackend(std::shared_ptr<Captured> captured) : captured_(std::move(captured)) {}
  ~CaptureBackend() override {
    if (captured_->end) captured_->end();
  }
  void apply(std::shared_ptr<const Commit> commit) override {
    if (captured_->failNextApply) {
      captured_->failNextApply = false;
      throw std::bad_alloc();
    }
    recordCall('a');
    captured_->validator.check(*commit);
    captured_->commits.push_back(std::move(commit));
  }
  bool pipelines() const override { return captured_->pipelines; }
  void start() override {
    captured_->starts++;
    recordCall('s');
  }
  void wait() override {
    captured_->waits++;
    recordCall('w');
    if (std::exchange(captured_->failNextWait, false))
      throw ClusterError("2 workers are needed, there is 1");
  }
  void cancel() override {
    captured_->cancels++;
    captured_->backendCalls += 'c';
  }
  std::vector<RTworker> workers() const override {
    std::vector<RTworker> workers(2);
    workers[0].threads = 3;
    workers[1].threads = 4;
    return workers;
  }
  float progress() const override { return 0.25f; }
  bool read(RTenum channel, std::span<float> out) const override {
    for (size_t i = 0; i < out.size(); i++) out[i] = static_cast<float>(channel);
    return true;
  }
  void stats(RTstats& stats) const override {
    stats.rays.camera = 42;
    stats.rejected.primitives = 1;
  }
  Queries* queries() override { return &queries_; }

 private:
  void recordCall(char what) {
    captured_->backendCalls += what;
    if (captured_->cancelIn.find(what) != std::string::npos) rtCancel(rtGetCurrent());
  }
  std::shared_ptr<Captured> captured_;
  FakeQueries queries_;
};

// A context whose commits can be inspected. TearDown() checks that no error is pending.
class ApiTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string plugins = OPENRT_TEST_PLUGINS;
    captured = std::make_shared<Captured>(plugins);
    ContextConfig config;
    config.shaderPath = plugins + "/stock:" + plugins;
    handle =
        adoptContext(std::make_shared<Context>(config, std::make_unique<CaptureBackend>(captured)));
    rtFrameBuffer(4, 2, RT_RGBA);
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(handle);
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  }

  // Commits and returns what the backend received.
  const Commit& commit() {
    const size_t before = captured->commits.size();
    rtRender();
    EXPECT_EQ(captured->commits.size(), before + 1);
    static const Commit none;
    return captured->commits.size() > before ? *captured->commits.back() : none;
  }

  std::shared_ptr<Captured> captured;
  RTcontext handle = nullptr;
};

// Returns the edits of one kind in a commit, in order: edits<edit::InstanceT>(commit).
template <class T> std::vector<const T*> edits(const Commit& commit) {
  std::vector<const T*> result;
  for (const auto& entry : commit.edits.edits)
    if (entry->any.type == edit::AnyUnionTraits<T>::enum_value)
      result.push_back(static_cast<const T*>(entry->any.value));
  return result;
}

template <class T> std::vector<T> contents(const Commit& commit, ArrayId id) {
  if (id == 0) return {};
  const Array& array = *commit.arrays.at(id);
  return std::vector<T>(array.as<T>(), array.as<T>() + array.count<T>());
}

inline std::vector<double> matrixOf(const edit::Matrix& m) {
  std::vector<double> values;
  for (int i = 0; i < 16; i++) values.push_back(m.m()->Get(i));
  return values;
}

inline std::vector<double> currentMatrix() {
  std::vector<double> m(16);
  rtGetMatrixd(m.data());
  return m;
}

// Checks the code of the pending error.
#define EXPECT_RT_ERROR(code)                                                                      \
  do { EXPECT_EQ(rtGetError(), RTenum(code)) << rtGetErrorMessage(); } while (0)

// Checks that a call fails with this error.
#define EXPECT_FAILS(code, call)                                                                   \
  do {                                                                                             \
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << "before " #call ": " << rtGetErrorMessage();   \
    call;                                                                                          \
    EXPECT_EQ(rtGetError(), RTenum(code)) << #call ": " << rtGetErrorMessage();                    \
  } while (0)

inline RTid triangleObject() {
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 0, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  return object;
}

} // namespace openrt::test
