// openrt_api_life.cpp: contexts, their configuration, errors and callbacks.
#include <cstring>
#include <thread>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

TEST(ApiConfig, ReadsPairsAndQuotes) {
  const ContextConfig config =
      parseConfig("  backend=record\tthreads=3 file=\"a file\" shaderpath=/a:/b ");
  EXPECT_EQ(config.backend, BackendKind::Record);
  EXPECT_EQ(config.threads, 3u);
  EXPECT_EQ(config.file, "a file");
  EXPECT_EQ(config.shaderPath, "/a:/b");
  EXPECT_EQ(parseConfig("record=out.ortr backend=local").record, "out.ortr");
  EXPECT_EQ(config.isa, "auto");
  EXPECT_EQ(parseConfig("isa=avx2").isa, "avx2");
  EXPECT_TRUE(config.lightSamples && parseConfig("lightsamples=on").lightSamples);
  EXPECT_FALSE(parseConfig("lightsamples=off").lightSamples);
  EXPECT_EQ(parseConfig("").backend, BackendKind::Local);
  const ContextConfig cluster =
      parseConfig("workers=a:7447,[::1]:9,@hosts.txt backend=cluster listen=127.0.0.1:0 key=k "
                  "allow=l local=0 split=samples require=2 tolerant=1 record=out.ortr");
  EXPECT_EQ(cluster.backend, BackendKind::Cluster);
  EXPECT_EQ(cluster.cluster.workers, (std::vector<std::string>{"a:7447", "[::1]:9", "@hosts.txt"}));
  EXPECT_TRUE(cluster.cluster.keyFile == "k" && cluster.cluster.allowFile == "l" &&
              cluster.cluster.listen == "127.0.0.1:0");
  EXPECT_TRUE(cluster.cluster.local == 0u && cluster.cluster.split == "samples" &&
              cluster.cluster.require == 2);
  EXPECT_TRUE(cluster.cluster.tolerant && cluster.record == "out.ortr");
  EXPECT_FALSE(parseConfig("backend=cluster workers=a").cluster.local.has_value());
}

TEST(ApiConfig, RefusesNonsense) {
  for (const char* text : {"backend=gpu",
                           "threads=-1",
                           "threads=",
                           "threads=2x",
                           "threads=5000",
                           "isa=",
                           "isa=mmx",
                           "isa=avx2,sse2",
                           "backend=null isa=sse2",
                           "backend=record file=a isa=sse2",
                           "lightsamples=",
                           "lightsamples=0",
                           "backend=null lightsamples=off",
                           "backend=cluster workers=a lightsamples=off",
                           "nonsense=1",
                           "backend",
                           "=1",
                           "file=\"open",
                           "file=\"a\"b backend=record",
                           "backend=record",
                           "backend=record file=a record=b",
                           "file=a",
                           "backend =local",
                           "backend=cluster",
                           "workers=a",
                           "backend=null local=0",
                           "backend=cluster workers=a,,b",
                           "backend=cluster workers=",
                           "backend=cluster workers=a, ",
                           "backend=cluster workers=a split=pixels",
                           "backend=cluster workers=a require=-1",
                           "backend=cluster workers=a tolerant=yes"}) {
    EXPECT_EQ(rtNewContext(text), nullptr) << text;
    EXPECT_RT_ERROR(RT_INVALID_VALUE);
    EXPECT_EQ(rtGetCurrent(), nullptr);
  }
}

TEST(ApiLife, ARecordingThatCannotBeWrittenIsAnIoError) {
  EXPECT_EQ(rtNewContext("backend=record file=/nonexistent/folder/file"), nullptr);
  EXPECT_RT_ERROR(RT_IO_ERROR);
  EXPECT_NE(std::string(rtGetErrorMessage()).find("/nonexistent/folder/file"), std::string::npos);
}

TEST(ApiLife, CallsWithoutAContextFail) {
  rtMakeCurrent(nullptr);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtBegin(RT_POINTS));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtRender());
  EXPECT_EQ(rtBeginObject(0), 0u);
  EXPECT_EQ(rtParameterHandle("x"), -1);
  EXPECT_RT_ERROR(RT_INVALID_OPERATION);
}

TEST(ApiLife, TheFirstErrorSticksUntilItIsRead) {
  const RTcontext context = rtNewContext("backend=null");
  rtPopMatrix();
  rtBegin(99);
  EXPECT_RT_ERROR(RT_STACK_UNDERFLOW);
  EXPECT_NE(std::string(rtGetErrorMessage()).find("rtPopMatrix"), std::string::npos);
  EXPECT_RT_ERROR(RT_NO_ERROR);
  EXPECT_STREQ(rtGetErrorMessage(), "");
  rtDeleteContext(context);
}

TEST(ApiLife, EachThreadHasItsOwnCurrentContext) {
  const RTcontext a = rtNewContext("backend=null");
  RTcontext elsewhere = a;
  RTcontext b = nullptr;
  std::thread([&] {
    elsewhere = rtGetCurrent();
    b = rtNewContext("backend=null");
    EXPECT_EQ(rtGetCurrent(), b);
  }).join();
  EXPECT_EQ(elsewhere, nullptr);
  EXPECT_EQ(rtGetCurrent(), a);
  rtMakeCurrent(b);
  EXPECT_EQ(rtGetCurrent(), b);
  rtDeleteContext(b);
  EXPECT_EQ(rtGetCurrent(), nullptr);
  rtDeleteContext(a);
  EXPECT_RT_ERROR(RT_NO_ERROR);
}

TEST(ApiLife, ADeletedContextIsGoneOnEveryThread) {
  const RTcontext context = rtNewContext("backend=null");
  std::thread([&] { rtDeleteContext(context); }).join();
  EXPECT_EQ(rtGetCurrent(), nullptr);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtLoadIdentity());
  EXPECT_FAILS(RT_INVALID_VALUE, rtMakeCurrent(context));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDeleteContext(context));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCancel(context));
  EXPECT_FAILS(RT_INVALID_VALUE, rtProgress(context));
  rtDeleteContext(nullptr);
  EXPECT_RT_ERROR(RT_NO_ERROR);
}

TEST(ApiLife, ContextsDoNotShareIds) {
  const RTcontext a = rtNewContext("backend=null");
  const RTid object = triangleObject();
  const RTcontext b = rtNewContext("backend=null");
  EXPECT_FAILS(RT_INVALID_ID, rtInstantiateObject(object));
  rtDeleteContext(a);
  rtDeleteContext(b);
}

TEST(ApiLife, InitTakesItsOptionsOutOfTheArguments) {
  char program[] = "program", backend[] = "--rt-backend=null", other[] = "--other",
       threads[] = "--rt-threads=1", file[] = "a.wrl";
  char* argv[] = {program, backend, other, threads, file, nullptr};
  int argc = 5;
  rtInit(&argc, argv);
  EXPECT_RT_ERROR(RT_NO_ERROR);
  ASSERT_EQ(argc, 3);
  EXPECT_EQ(argv[1], other);
  EXPECT_EQ(argv[2], file);
  EXPECT_EQ(argv[3], nullptr);
  EXPECT_NE(rtGetCurrent(), nullptr);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInit(nullptr, nullptr));
  rtExit();
  EXPECT_EQ(rtGetCurrent(), nullptr);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtExit());
}

TEST(ApiLife, AFailedInitLeavesTheArguments) {
  char program[] = "program", bad[] = "--rt-backend=gpu", worse[] = "--rt-backend";
  for (char* option : {bad, worse}) {
    char* argv[] = {program, option, nullptr};
    int argc = 2;
    EXPECT_FAILS(RT_INVALID_VALUE, rtInit(&argc, argv));
    EXPECT_EQ(argc, 2);
    EXPECT_EQ(argv[1], option);
  }
}

struct Heard {
  int calls = 0;
  RTenum error = 0;
  std::string text;
};
void hear(RTenum error, const char* message, void* user) {
  Heard& heard = *static_cast<Heard*>(user);
  heard.calls++;
  heard.error = error;
  heard.text = message;
}
void throwSomething(RTenum, const char*, void*) { throw 1; }

// A backend waits for its threads in its destructor. One of them may be in the log callback.
TEST(ApiLife, AThreadOfABackendThatEndsMayStillAsk) {
  const auto captured = std::make_shared<Captured>(std::vector<std::string>());
  Context context(ContextConfig(), std::make_unique<CaptureBackend>(captured));
  float progress = -1;
  size_t workers = 1;
  bool copied = true;
  captured->end = [&] {
    std::thread([&] {
      progress = context.progress();
      workers = context.workers().size();
      copied = context.snapshot(RT_DEPTH, {});
      context.cancel();
    }).join();
  };
  EXPECT_EQ(context.progress(), 0.25f);
  EXPECT_EQ(context.close(), nullptr);
  EXPECT_EQ(progress, 0);
  EXPECT_EQ(workers, 0u);
  EXPECT_FALSE(copied);
}

TEST_F(ApiTest, TheErrorCallbackHearsEveryErrorAtOnce) {
  Heard heard;
  rtErrorCallback(hear, &heard);
  rtPopMatrix();
  EXPECT_EQ(heard.calls, 1);
  rtLineWidth(-1);
  EXPECT_EQ(heard.calls, 2);
  EXPECT_EQ(heard.error, RTenum(RT_INVALID_VALUE));
  EXPECT_NE(heard.text.find("rtLineWidth"), std::string::npos);
  rtErrorCallback(nullptr, nullptr);
  rtLineWidth(-1);
  EXPECT_EQ(heard.calls, 2);
  EXPECT_RT_ERROR(RT_STACK_UNDERFLOW);
}

TEST_F(ApiTest, AnExceptionOfTheErrorCallbackDoesNotLeaveTheLibrary) {
  rtErrorCallback(throwSomething, nullptr);
  EXPECT_FAILS(RT_STACK_UNDERFLOW, rtPopMatrix());
}

TEST_F(ApiTest, CancelAndProgressComeFromAnyThread) {
  rtSwapBuffers();
  float progress = 0;
  std::thread([&] {
    rtCancel(handle);
    progress = rtProgress(handle);
  }).join();
  EXPECT_EQ(captured->cancels, 1);
  EXPECT_EQ(progress, 0.25f);
}

TEST_F(ApiTest, DeletingAContextCancelsItsFrame) {
  rtSwapBuffers();
  rtDeleteContext(handle);
  EXPECT_EQ(captured->cancels, 1);
  EXPECT_EQ(captured->waits, 1);
  handle = nullptr;
}

} // namespace
