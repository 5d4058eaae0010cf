#include "run/leave_memory.h"

#include <vector>

namespace vv {

namespace {

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VV_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VV_SANITIZED
#endif

#ifdef VV_SANITIZED
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

bool freesAll = false;

} // namespace

bool leavesMemory(const Options& options, const xvrml::Browser& browser) {
  return !sanitized && !freesAll && !options.watch && !options.render.cluster &&
         browser.scripts().scripts == 0;
}

void freeAllMemory() { freesAll = true; }

void leave(std::shared_ptr<void> object) {
  static auto& left = *new std::vector<std::shared_ptr<void>>; // never destroyed
  left.push_back(std::move(object));
}

} // namespace vv
