// ppm.cpp: Encodes PPM: 8-bit red, green, blue without compression. [any thread]
#include "libpicture/files/formats.h"

namespace picture {

std::string encodePpm(const Picture& picture) {
  std::string out = "P6\n";
  if (!picture.note.empty()) out += "# " + picture.note + "\n";
  out += std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n255\n";
  std::vector<uint8_t> bytes = displayBytesAlone(picture);
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return out;
}

} // namespace picture
