// file_head.cpp: names and kinds of the encodings. They are not inline, so that programs built
// before an encoding was added know it as soon as the library does.
#include "xvrml/file_head.h"

#include <array>

namespace xvrml {
namespace {

struct EncodingInfo {
  std::string_view name;
  bool mesh = false;
};

// In the order of Encoding.
constexpr auto encodings = std::to_array<EncodingInfo>({{"VRML97"},
                                                        {"X3D ClassicVRML"},
                                                        {"X3D XML"},
                                                        {"X3D JSON"},
                                                        {"VRML 1.0"},
                                                        {"STL", true},
                                                        {"PLY", true},
                                                        {"Wavefront OBJ", true},
                                                        {"glTF", true},
                                                        {"OFF", true}});
static_assert(encodings.size() == size_t(Encoding::off) + 1);

} // namespace

int encodingCount() { return int(encodings.size()); }

std::string_view encodingName(Encoding encoding) {
  return size_t(encoding) < encodings.size() ? encodings[size_t(encoding)].name : "unknown";
}

bool isMesh(Encoding encoding) {
  return size_t(encoding) < encodings.size() && encodings[size_t(encoding)].mesh;
}

} // namespace xvrml
