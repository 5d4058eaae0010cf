// main.cpp: xvrml-decoder: decodes the pictures and sounds of worlds whose formats need large
// libraries, in the cage (serve.h).
#include <ImfThreading.h>
#include <unistd.h>

#include "serve.h"

namespace xvrml::decoding {
namespace {

void prepare() {
  Imf::setGlobalThreadCount(0); // no thread may be made in the cage
}

void decode(const Request& request, std::span<const uint8_t> file, Answer& answer) {
  switch (request.format) {
  case Format::exr: return decodeOpenExr(file, answer);
  case Format::webp: return decodeWebp(file, answer);
  case Format::bitmap: return decodeBitmap(file, answer);
  case Format::sound: return decodeSound(file, answer);
  case Format::step: break; // another program reads it
  }
  _exit(1);
}

constexpr Service service = {"xvrml-decoder decodes pictures and sounds of worlds for the XVRML "
                             "library, which starts it.\n",
                             prepare, decode};

} // namespace
} // namespace xvrml::decoding

int main(int argc, char** argv) {
  return xvrml::decoding::serveFiles(argc, argv, xvrml::decoding::service);
}
