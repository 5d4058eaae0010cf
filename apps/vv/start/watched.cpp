#include "start/watched.h"

#include <chrono>
#include <cstdlib>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include <sys/stat.h>

#include "folder_files.h"
#include "report/describe.h"
#include "system/files.h"

namespace vv {

std::vector<std::string> usedFiles(const xvrml::World& world) {
  std::set<std::string> files{world.path};
  const std::string* last = nullptr; // the file of the last node; most nodes are in the same file
  forEachNode(world, [&](const xvrml::Node& node) {
    if (node.source.file && node.source.file.get() != last) files.insert(*node.source.file);
    last = node.source.file.get();
    for (const xvrml::FieldInfo& field : node.type().fields) {
      if (node.type().index >= 0 && !field.holdsUrls) continue;
      if (!holdsUrls(node, field)) continue;
      const auto& file = urlBase(node, field);
      const std::string base = file ? *file : world.path;
      for (const std::string& url : *static_cast<const xvrml::MFString*>(node.storage(field)))
        if (auto resolved = xvrml::resolveUrl(url, base, world.options); resolved.error.empty())
          files.insert(resolved.path);
    }
  });
  for (const xvrml::ProtoPtr& prototype : world.scope.prototypes)
    for (const std::string& url : prototype->urls)
      if (auto resolved = xvrml::resolveUrl(url, prototype->baseUrl, world.options);
          resolved.error.empty())
        files.insert(resolved.path);
  return {files.begin(), files.end()};
}

std::vector<std::string> shaderFiles(const std::string& shaderPath) {
  const char* const environment = std::getenv("OPENRT_SHADER_PATH");
  std::istringstream folders(shaderPath + ":" + (environment ? environment : ""));
  std::vector<std::string> files;
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty()) continue;
    for (std::string& file : filesOfFolder(folder, ".so")) files.push_back(std::move(file));
  }
  return files;
}

Watched::Stamp Watched::stampOf(const std::string& path) {
  struct stat info;
  if (::stat(path.c_str(), &info) != 0) return {};
  const timespec modified = os::modifiedTime(info);
  return {modified.tv_sec, modified.tv_nsec, info.st_size, info.st_ino};
}

timespec Watched::now() { return os::fileClock(); }

void Watched::add(const std::vector<std::string>& files, timespec read) {
  for (const std::string& file : files) {
    const Stamp stamp = stampOf(file);
    const bool since = std::pair(stamp.seconds, stamp.nanoseconds) >
                       std::pair<long long, long long>(read.tv_sec, read.tv_nsec);
    files_.try_emplace(file, since ? Stamp{} : stamp);
  }
}

bool Watched::update() {
  bool changed = false;
  for (auto& [path, stamp] : files_) {
    const Stamp now = stampOf(path);
    changed |= !(now == stamp);
    stamp = now;
  }
  return changed;
}

bool Watched::changed() {
  const bool fresh = update();
  const bool ready = pending_ && !fresh;
  pending_ = fresh || (pending_ && !ready);
  return ready;
}

bool Watched::waitForChange(bool (*ended)()) {
  constexpr auto pause = std::chrono::milliseconds(200);
  for (;;) {
    if (ended()) return false;
    if (changed()) return true;
    std::this_thread::sleep_for(pause);
  }
}

} // namespace vv
