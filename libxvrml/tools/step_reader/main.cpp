// main.cpp: xvrml-step-reader: turns STEP models into glTF by Open CASCADE, in the cage.
#include <unistd.h>

#include "step.h"
#include "tools/decoder/serve.h"

namespace xvrml::decoding {
namespace {

void decode(const Request& request, std::span<const uint8_t> file, Answer& answer) {
  if (request.format != Format::step) _exit(1);
  decodeStep(request, file, answer);
}

constexpr Service service = {"xvrml-step-reader reads STEP models for the XVRML library, which "
                             "starts it.\n",
                             prepareStep, decode};

} // namespace
} // namespace xvrml::decoding

int main(int argc, char** argv) {
  return xvrml::decoding::serveFiles(argc, argv, xvrml::decoding::service);
}
