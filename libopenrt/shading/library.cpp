// library.cpp: loads a shader library and merges its parameter tables with those of the version
// that it replaces. Called by the registry under its lock.
#include "shading/library.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plugin_library.h"
#include "shading/plugin_check.h"
#include "system/files.h"
#include "system/libraries.h"

namespace openrt {

constinit thread_local const RtsClass* runningClass OPENRT_SIGNAL_SAFE_TLS = nullptr;

const char* runningShader() noexcept { return runningClass ? labelOf(*runningClass) : nullptr; }

namespace {

[[noreturn]] void failLoading(const std::string& path, const std::string& why) {
  throw std::runtime_error("shader library " + path + ": " + why);
}

// A copy of a file in a new folder that only this user can write to. The destructor removes both; a
// library that was loaded from it stays loaded.
class PrivateCopy {
 public:
  PrivateCopy(const std::string& path, const std::string& name) {
    std::error_code error;
    std::string folder = (plugin_files::fs::temp_directory_path(error) / "openrt-XXXXXX").string();
    if (error || !mkdtemp(folder.data()))
      failLoading(path, std::string("no folder for a copy: ") + std::strerror(errno));
    folder_ = folder;
    file_ = folder_ / (name + ".so");
    if (!plugin_files::fs::copy_file(path, file_, error)) {
      remove();
      failLoading(path, "cannot be copied: " + error.message());
    }
  }
  ~PrivateCopy() { remove(); }
  PrivateCopy(const PrivateCopy&) = delete;
  PrivateCopy& operator=(const PrivateCopy&) = delete;
  const plugin_files::fs::path& file() const { return file_; }

 private:
  void remove() {
    std::error_code ignored;
    plugin_files::fs::remove_all(folder_, ignored);
  }
  plugin_files::fs::path folder_, file_;
};

// Returns whether the file at this path differs from the one first loaded from it by this process.
// The dynamic loader would return the old library, because it knows the path. A registry cannot
// detect this by itself: another registry may have loaded the file, or an earlier one may have left
// it loaded.
bool replacedSinceLoaded(const std::string& path, const FileStamp& stamp) {
  static std::mutex mutex;
  static std::map<std::string, FileStamp>& loaded =
      *new std::map<std::string, FileStamp>; // outlives every registry
  const std::lock_guard lock(mutex);
  return !(loaded.try_emplace(path, stamp).first->second == stamp);
}

const std::string& nameOf(const LoadedClass& c, uint32_t i, std::string& storage) {
  if (i < c.mergedNames.size()) return c.mergedNames[i];
  return storage = c.params[i].name;
}

uint8_t frequencyOf(const RtsClass& c, uint32_t i) {
  return c.frequency ? c.frequency[i] : uint8_t(RTS_PER_SHADER);
}

// Orders the parameters of a class as in the table before, so that handles stay valid.
void keepHandles(LoadedClass& fresh, const LoadedClass& before) {
  std::vector<RtsParam> params;
  std::vector<uint8_t> frequency;
  std::vector<std::string> names;
  std::vector<bool> placed(fresh.paramCount);
  size_t size = (size_t(fresh.paramSize) + 15) / 16 * 16;
  std::string storage;
  for (uint32_t i = 0; i < before.paramCount; i++) {
    const std::string name = nameOf(before, i, storage);
    uint32_t j = 0;
    while (j < fresh.paramCount && (placed[j] || fresh.params[j].name != name ||
                                    fresh.params[j].type != before.params[i].type))
      j++;
    names.push_back(name);
    if (j < fresh.paramCount) {
      placed[j] = true;
      params.push_back(fresh.params[j]);
      frequency.push_back(frequencyOf(fresh, j));
      continue;
    }
    // The parameter no longer exists. Its name and text must not point into the old library.
    RtsParam removed = before.params[i];
    removed.name = "";
    removed.text = "no longer declared";
    removed.offset = uint32_t(size);
    size += (parameterBytes(removed.type) + 15) / 16 * 16;
    params.push_back(removed);
    frequency.push_back(frequencyOf(before, i));
  }
  for (uint32_t j = 0; j < fresh.paramCount; j++) {
    if (placed[j]) continue;
    params.push_back(fresh.params[j]);
    frequency.push_back(frequencyOf(fresh, j));
    names.emplace_back(fresh.params[j].name);
  }
  fresh.mergedParams = std::move(params);
  fresh.mergedFrequency = std::move(frequency);
  fresh.mergedNames = std::move(names);
  fresh.paramSize = uint32_t(size);
  fresh.paramCount = uint32_t(fresh.mergedParams.size());
  fresh.params = fresh.mergedParams.data();
  fresh.frequency = fresh.mergedFrequency.data();
}

} // namespace

FileStamp FileStamp::of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
  const timespec modified = os::modifiedTime(info);
  return {info.st_dev, info.st_ino, info.st_size, modified.tv_sec, modified.tv_nsec};
}

void ShaderLibrary::open(const std::string& file) {
  handle = plugin_files::openLibrary(file, "shader library");
}

void ShaderLibrary::readClasses() {
  void* symbol = dlsym(handle, RTS_ENTRY_NAME);
  if (!symbol) failLoading(path, "exports no " RTS_ENTRY_NAME ", so it is not a shader plug-in");
  for (const RtsClass& c :
       checkPlugin(static_cast<const RtsPlugin*>(symbol), os::exportedBytes(symbol), path)) {
    auto loaded = std::make_unique<LoadedClass>();
    static_cast<RtsClass&>(*loaded) = c;
    loaded->label = std::string(c.name) + " of " + name;
    classes.push_back(std::move(loaded));
  }
}

ShaderLibrary::ShaderLibrary(std::string bareName, std::string file)
    : name(std::move(bareName)), path(std::move(file)), stamp(FileStamp::of(path)) {
  plugin_files::checkFile(path, "shader library");
  if (replacedSinceLoaded(path, stamp))
    open(PrivateCopy(path, name).file().string());
  else
    open(path);
  try {
    readClasses();
  } catch (...) {
    dlclose(handle);
    throw;
  }
}

ShaderLibrary::ShaderLibrary(std::string bareName, std::string file, const ShaderLibrary& before,
                             uint32_t number)
    : name(std::move(bareName)), path(std::move(file)), stamp(FileStamp::of(path)) {
  plugin_files::checkFile(path, "shader library");
  {
    const PrivateCopy copy(path, name + "." + std::to_string(number));
    open(copy.file().string());
  }
  try {
    readClasses();
    for (const auto& former : before.classes) {
      LoadedClass* same = nullptr;
      for (const auto& c : classes)
        if (std::strcmp(c->name, former->name) == 0) same = c.get();
      if (same && same->kind == former->kind) {
        keepHandles(*same, *former);
        same->found = former->found.load();
      } else if (former->found) {
        failLoading(path, std::string("its class ") + former->name +
                              (same ? " is of another kind now" : " is gone") + ", but in use");
      }
    }
  } catch (...) {
    dlclose(handle);
    throw;
  }
}

ShaderLibrary::~ShaderLibrary() { dlclose(handle); }

const RtsClass* ShaderLibrary::find(std::string_view className) const {
  for (const auto& c : classes)
    if (className == c->name) {
      c->found = true;
      return c.get();
    }
  return nullptr;
}

} // namespace openrt
