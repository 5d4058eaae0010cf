// system_calls.cpp: tests of common/system, which has a function for each call that not every
// system has.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>

#include "shortage.h"
#include "start_threads.h"
#include "system/files.h"
#include "system/libraries.h"
#include "system/memory.h"
#include "system/process.h"
#include "system/random.h"
#include "system/sockets.h"
#include "system/threads.h"
#include "system/wake_up.h"

namespace {

bool readable(int fd, int milliseconds) {
  pollfd ready{fd, POLLIN, 0};
  return os::pollFor(ready, int64_t(milliseconds) * 1'000'000) == 1;
}

TEST(SystemCalls, AWakeUpIsReadableFromACallUntilItIsCleared) {
  os::WakeUp wake;
  EXPECT_FALSE(readable(wake.fd(), 0));
  EXPECT_FALSE(wake.clear());
  std::thread([&wake] {
    for (int k = 0; k < 100'000; ++k) wake.call(); // more than a pipe holds
  }).join();
  EXPECT_TRUE(readable(wake.fd(), 10'000));
  EXPECT_TRUE(wake.clear());
  EXPECT_FALSE(readable(wake.fd(), 0));
  EXPECT_FALSE(wake.clear());
}

TEST(SystemCalls, StreamsSayWhoseTheyAreAndRaiseNoSignal) {
  int ends[2];
  ASSERT_EQ(os::streamPair(ends), 0);
  EXPECT_EQ(os::peerUser(ends[0]), ::geteuid());
  for (const int end : ends) EXPECT_NE(::fcntl(end, F_GETFD) & FD_CLOEXEC, 0);
  ::close(ends[1]);
  EXPECT_EQ(::send(ends[0], "x", 1, os::noSignal), -1); // SIGPIPE would end this program
  EXPECT_EQ(errno, EPIPE);
  ::close(ends[0]);
  EXPECT_FALSE(os::peerUser(-1));
}

TEST(SystemCalls, AStreamSocketDoesNotBlock) {
  const int fd = os::streamSocket(AF_UNIX);
  ASSERT_GE(fd, 0);
  EXPECT_NE(::fcntl(fd, F_GETFD) & FD_CLOEXEC, 0);
  EXPECT_NE(::fcntl(fd, F_GETFL) & O_NONBLOCK, 0);
  ::close(fd);
  EXPECT_EQ(os::acceptStream(-1), -1);
}

TEST(SystemCalls, AProcessIsSeenToComputeIsTimedAndEnded) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, os::closeFrom(&actions, 3));
  std::array<char*, 4> words{const_cast<char*>("sh"), const_cast<char*>("-c"),
                             const_cast<char*>("while :; do :; done"), nullptr};
  pid_t process = 0;
  ASSERT_EQ(posix_spawn(&process, "/bin/sh", &actions, &attributes, words.data(), nullptr), 0);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  const int descriptor = os::processDescriptor(process);
  while (os::processorSeconds(process) < 0.01) std::this_thread::yield();
  bool computed = false;
  for (int k = 0; k < 10'000 && !computed; ++k) computed = os::computes(process);
  EXPECT_TRUE(computed);
  os::endProcess(process, descriptor);
  int status = 0;
  ASSERT_EQ(waitpid(process, &status, 0), process);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
  EXPECT_EQ(os::signalName(SIGKILL), "Killed");
  EXPECT_EQ(os::processorSeconds(process), 0);
  EXPECT_FALSE(os::computes(process));
  if (descriptor >= 0) ::close(descriptor);
}

TEST(SystemCalls, ALibraryDefinesItsOwnFunctionsOnly) {
  void* const library = dlopen(nullptr, RTLD_LAZY);
  ASSERT_TRUE(library);
  EXPECT_FALSE(os::defines(library, dlsym(library, "malloc")));
  EXPECT_FALSE(os::defines(library, nullptr));
  EXPECT_EQ(os::trustedEnvironment("OPENRT_NO_SUCH_VARIABLE"), nullptr);
  dlclose(library);
}

TEST(SystemCalls, FilesHaveTimesBetweenTheirClockAndThePreciseOne) {
  const timespec before = os::fileClock();
  const std::string name =
      testing::TempDir() + "system_calls_" + std::to_string(::getpid()) + ".txt";
  std::ofstream(name) << "x";
  struct stat status {};
  ASSERT_EQ(::stat(name.c_str(), &status), 0);
  const timespec changed = os::modifiedTime(status);
  const auto nanoseconds = [](timespec t) { return int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec; };
  EXPECT_GE(nanoseconds(changed), nanoseconds(before));
  timespec after{};
  clock_gettime(CLOCK_REALTIME, &after);
  EXPECT_LE(nanoseconds(changed), nanoseconds(after));
  std::filesystem::remove(name);

  std::error_code error;
  EXPECT_EQ(os::programFile(error).filename(), "unit_system");
  EXPECT_FALSE(error);
}

TEST(SystemCalls, StacksBlocksAndProcessors) {
  const char here = 0;
  const char* const lowest = os::stackBottom();
  ASSERT_TRUE(lowest);
  EXPECT_LT(lowest, &here);
  EXPECT_LT(&here - lowest, ptrdiff_t(1) << 32);
  EXPECT_GE(os::allowedProcessors(), 1u);
  void* const block = std::malloc(1000);
  EXPECT_GE(os::blockBytes(block), 1000u);
  os::giveBackMemory(); // what is in use stays
  std::free(block);
  EXPECT_GT(os::addressSpace(), 1u << 20);
}

TEST(SystemCalls, RandomBytesDiffer) {
  std::array<unsigned char, 1000> a{}, b{};
  os::fillRandomly(a.data(), a.size());
  os::fillRandomly(b.data(), b.size());
  EXPECT_NE(a, b);
  EXPECT_NE(std::count(a.begin(), a.end(), 0), 1000);
  EXPECT_NE(a.back() + a[a.size() - 2] + a[a.size() - 3] + a[a.size() - 4], 0);
}

#if defined(__linux__)
// In a process of its own, whose address space has room for some stacks only.
TEST(SystemCalls, WhereThreadsAreShortFewerOfThemDoTheWork) {
  constexpr rlim_t room = 1 << 28;
  const pid_t child = ::fork();
  if (child == 0) {
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t bytes = rlim_t(pages) * rlim_t(::sysconf(_SC_PAGESIZE)) + room;
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_AS, &limit);
    std::atomic<bool> ended{false};
    std::vector<std::thread> threads;
    startThreads(threads, 1000, [&](size_t) { ended.wait(false); });
    const size_t started = threads.size();
    ended = true;
    ended.notify_all();
    for (std::thread& thread : threads) thread.join();
    ::_exit(started > 0 && started < 1000 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}
#endif

TEST(SystemCalls, ShortagesAreToldFromOtherErrors) {
  const auto of = [](std::errc code) { return std::system_error(std::make_error_code(code)); };
  EXPECT_TRUE(isShortage(std::bad_alloc()));
  EXPECT_TRUE(isShortage(of(std::errc::resource_unavailable_try_again)));
  EXPECT_TRUE(isShortage(of(std::errc::too_many_files_open)));
  EXPECT_FALSE(isShortage(of(std::errc::permission_denied)));
  EXPECT_FALSE(isShortage(std::runtime_error("x")));
}

} // namespace
