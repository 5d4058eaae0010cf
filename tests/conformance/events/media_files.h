// media_files.h: sounds and films that tests write to a folder of their own and play, with worlds
// beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

#include "conformance/events/support.h"

namespace xvrml {

// A folder that is removed with the object.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::path(testing::TempDir()) /
              fmt::format("xvrml_media_{}_{}", getpid(), ++count())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary)
        .write(bytes.data(), std::streamsize(bytes.size()));
  }
  std::unique_ptr<World> world(const std::string& vrml) const {
    return loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, *this / "world.wrl");
  }

 private:
  static int& count() {
    static int n = 0;
    return n;
  }
  std::filesystem::path path_;
};

inline std::string little(uint32_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += char(value >> (8 * i) & 255);
  return out;
}

// Returns a WAV file of 16-bit PCM.
inline std::string wav(const std::vector<int16_t>& samples, int channels, int rate) {
  std::string data;
  for (const int16_t s : samples) data += little(uint16_t(s), 2);
  const uint32_t frameBytes = uint32_t(channels) * 2;
  const std::string format = little(1, 2) + little(uint32_t(channels), 2) +
                             little(uint32_t(rate), 4) + little(uint32_t(rate) * frameBytes, 4) +
                             little(frameBytes, 2) + little(16, 2);
  const std::string body =
      "WAVEfmt " + little(16, 4) + format + "data" + little(uint32_t(data.size()), 4) + data;
  return "RIFF" + little(uint32_t(body.size()), 4) + body;
}

} // namespace xvrml
