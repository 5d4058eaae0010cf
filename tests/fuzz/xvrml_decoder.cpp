// xvrml_decoder.cpp: a process that decodes files answers with arbitrary bytes. The result is a
// picture or a sound of the size that was announced, or a message. The first byte chooses the file.
#include <array>
#include <cstdlib>
#include <stdexcept>

#include <sys/socket.h>
#include <unistd.h>

#include "behaviour/sound_file.h"
#include "decode/decoder.h"
#include "image/decoders.h"

namespace {

void decode(unsigned kind, const xvrml::ImageRoom& room) {
  if (kind == 0) {
    const xvrml::Clip clip = xvrml::readSound("data:,sound", room);
    if (clip.samples.size() != clip.frames() * size_t(clip.channels)) __builtin_trap();
    return;
  }
  using namespace std::string_view_literals;
  static constexpr std::array files = {"BM....\0\0\0\0"sv, "RIFF....WEBP"sv, "\x76\x2f\x31\x01"sv};
  const std::string_view file = files[(kind - 1) % files.size()];
  const auto* bytes = reinterpret_cast<const uint8_t*>(file.data());
  const auto picture = xvrml::decodePicture({bytes, file.size()}, room);
  if (const auto* image = std::get_if<xvrml::Image>(&picture))
    if (image->pixels.size() !=
        size_t(image->width) * size_t(image->height) * size_t(image->components))
      __builtin_trap();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  constexpr size_t most = 100'000; // fits into the socket's buffer
  if (size == 0 || size > most) return -1;
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
  if (::write(ends[1], data + 1, size - 1) != ssize_t(size - 1)) std::abort();
  ::shutdown(ends[1], SHUT_WR);
  struct Close {
    ~Close() { ::close(end); }
    int end;
  } const close{ends[1]};
  xvrml::Limits limits;
  limits.imagePixels = 1 << 20;
  xvrml::Budget budget(1 << 24);
  budget.decoder = std::make_shared<xvrml::Decoder>(ends[0]);
  decode(data[0] & 3, {limits, ~uint64_t(0), &budget});
  return 0;
} catch (const std::runtime_error&) { return 0; }
