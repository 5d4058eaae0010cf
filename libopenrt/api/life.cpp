// life.cpp: Implements the API functions for contexts and errors (rtNewContext, rtMakeCurrent,
// rtInit, rtGetError and related ones), and the table of live contexts, which validates handles on
// any thread.
#include <cstring>
#include <mutex>
#include <new>
#include <unordered_map>

#include "api/guard.h"

namespace openrt {

constinit thread_local Context* currentContext = nullptr;

namespace {

thread_local std::shared_ptr<Context> currentHandle;

struct LiveContexts {
  std::mutex mutex;
  std::unordered_map<RTcontext, std::shared_ptr<Context>> table;
  RTcontext initial = nullptr; // the context made by rtInit
};

// Returns the table. It is never destroyed, because threads may outlive the static objects of the
// process.
LiveContexts& live() {
  static LiveContexts* const contexts = new LiveContexts;
  return *contexts;
}

RTcontext initialContext() {
  const std::lock_guard lock(live().mutex);
  return live().initial;
}

RTcontext handleOf(Context* context) { return reinterpret_cast<RTcontext>(context); }

std::shared_ptr<Context> lookup(RTcontext handle) {
  const std::lock_guard lock(live().mutex);
  const auto found = live().table.find(handle);
  return found == live().table.end() ? nullptr : found->second;
}

void makeCurrent(std::shared_ptr<Context> context) {
  currentContext = context.get();
  currentHandle = std::move(context);
}

ErrorState& errorsHere() noexcept {
  return currentContext && currentContext->open() ? currentContext->errors : threadErrors();
}

// Runs body() for calls that need no current context. Records exceptions like guarded().
template <class Result, class Body>
Result guardedAnywhere(const char* function, Result failure, Body&& body) noexcept {
  try {
    return body();
  } catch (...) { recordCurrentException(errorsHere(), function); }
  return failure;
}

RTcontext newContext(const ContextConfig& config) {
  return adoptContext(std::make_shared<Context>(config));
}

void deleteContext(RTcontext handle) {
  std::shared_ptr<Context> context;
  {
    const std::lock_guard lock(live().mutex);
    const auto found = live().table.find(handle);
    if (found == live().table.end()) fail(RT_INVALID_VALUE, "not a context");
    context = found->second;
    live().table.erase(found);
    if (live().initial == handle) live().initial = nullptr;
  }
  if (currentContext == context.get()) makeCurrent(nullptr);
  if (const std::exception_ptr wrong = context->close()) std::rethrow_exception(wrong);
}

// Moves the arguments --rt-KEY=VALUE to the configuration and the others to `kept`.
ContextConfig configFromArguments(int argc, char** argv, std::vector<char*>& kept) {
  ContextConfig config;
  constexpr std::string_view prefix = "--rt-";
  for (int i = 0; i < argc; i++) {
    const std::string_view argument = argv[i] ? argv[i] : "";
    if (i == 0 || !argument.starts_with(prefix)) {
      kept.push_back(argv[i]);
      continue;
    }
    const std::string_view option = argument.substr(prefix.size());
    const size_t equals = option.find('=');
    if (equals == option.npos)
      fail(RT_INVALID_VALUE, "expected --rt-KEY=VALUE, not " + std::string(argument));
    config.set(option.substr(0, equals), option.substr(equals + 1));
  }
  config.check();
  return config;
}

void initialise(int* argc, char** argv) {
  const bool arguments = argc && argv && *argc > 0;
  std::vector<char*> kept;
  const ContextConfig config = arguments ? configFromArguments(*argc, argv, kept) : ContextConfig();
  if (initialContext()) fail(RT_INVALID_OPERATION, "called twice without rtExit");
  const RTcontext made = newContext(config);
  {
    const std::lock_guard lock(live().mutex);
    live().initial = made;
  }
  if (!arguments) return;
  const bool terminated =
      static_cast<int>(kept.size()) < *argc; // there is room for the final NULL of argv
  std::copy(kept.begin(), kept.end(), argv);
  if (terminated) argv[kept.size()] = nullptr;
  *argc = static_cast<int>(kept.size());
}

} // namespace

void reportNoContext(const char* function) noexcept {
  threadErrors().record(RT_INVALID_OPERATION, function, "no context is current on this thread");
}

std::shared_ptr<Context> findContext(RTcontext handle) { return lookup(handle); }

RTcontext adoptContext(std::shared_ptr<Context> context) {
  const RTcontext handle = handleOf(context.get());
  {
    const std::lock_guard lock(live().mutex);
    live().table.emplace(handle, context);
  }
  makeCurrent(std::move(context));
  return handle;
}

} // namespace openrt

using namespace openrt;

RTenum rtGetError(void) {
  const RTenum error = threadErrors().take();
  return error != RT_NO_ERROR || &errorsHere() == &threadErrors() ? error : errorsHere().take();
}

const char* rtGetErrorMessage(void) { return lastErrorMessage(); }

void rtErrorCallback(RTerrorCallback callback, void* user) {
  guarded("rtErrorCallback", [&](Context& c) { c.errors.setCallback(callback, user); });
}

void rtLogCallback(RTlogCallback callback, void* user) {
  guarded("rtLogCallback", [&](Context& c) { c.log.set(callback, user); });
}

RTcontext rtNewContext(const char* config) {
  return guardedAnywhere("rtNewContext", RTcontext(),
                         [&] { return newContext(parseConfig(config ? config : "")); });
}

void rtMakeCurrent(RTcontext context) {
  guardedAnywhere("rtMakeCurrent", 0, [&] {
    std::shared_ptr<Context> found = context ? lookup(context) : nullptr;
    if (context && !found) fail(RT_INVALID_VALUE, "not a context");
    makeCurrent(std::move(found));
    return 0;
  });
}

RTcontext rtGetCurrent(void) {
  return currentContext && currentContext->open() ? handleOf(currentContext) : nullptr;
}

void rtDeleteContext(RTcontext context) {
  if (!context) return;
  guardedAnywhere("rtDeleteContext", 0, [&] {
    deleteContext(context);
    return 0;
  });
}

void rtInit(int* argc, char** argv) {
  guardedAnywhere("rtInit", 0, [&] {
    initialise(argc, argv);
    return 0;
  });
}

void rtExit(void) {
  guardedAnywhere("rtExit", 0, [&] {
    const RTcontext initial = initialContext();
    if (!initial) fail(RT_INVALID_OPERATION, "rtInit was not called");
    deleteContext(initial);
    return 0;
  });
}

void rtCancel(RTcontext context) {
  guardedAnywhere("rtCancel", 0, [&] {
    const std::shared_ptr<Context> found = lookup(context);
    if (!found) fail(RT_INVALID_VALUE, "not a context");
    found->cancel();
    return 0;
  });
}

int rtSnapshot(RTcontext context, RTenum channel, float* out, size_t count) {
  return guardedAnywhere("rtSnapshot", 0, [&] {
    const std::shared_ptr<Context> found = lookup(context);
    if (!found) fail(RT_INVALID_VALUE, "not a context");
    if (!out) fail(RT_INVALID_VALUE, "the pointer is NULL");
    return found->snapshot(channel, {out, count}) ? 1 : 0;
  });
}

size_t rtGetWorkers(RTcontext context, RTworker* out, size_t count) {
  return guardedAnywhere("rtGetWorkers", size_t(0), [&] {
    const std::shared_ptr<Context> found = lookup(context);
    if (!found) fail(RT_INVALID_VALUE, "not a context");
    if (!out && count > 0) fail(RT_INVALID_VALUE, "the pointer is NULL");
    const size_t size = count > 0 ? out->size : sizeof(RTworker);
    if (size < sizeof(size_t))
      fail(RT_INVALID_VALUE, "set size to sizeof(RTworker) before the call");
    const std::vector<RTworker> workers = found->workers();
    for (size_t i = 0; i < std::min(count, workers.size()); i++) {
      // The structures of an older program are shorter.
      RTworker worker = workers[i];
      worker.size = size;
      std::memcpy(reinterpret_cast<std::byte*>(out) + i * size, &worker,
                  std::min(size, sizeof(worker)));
    }
    return workers.size();
  });
}

float rtProgress(RTcontext context) {
  return guardedAnywhere("rtProgress", 0.0f, [&] {
    const std::shared_ptr<Context> found = lookup(context);
    if (!found) fail(RT_INVALID_VALUE, "not a context");
    return found->progress();
  });
}
