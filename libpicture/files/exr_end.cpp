#include "libpicture/files/exr_end.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "libpicture/files/byte_reader.h"

namespace picture {

namespace {

constexpr uint32_t version = 2, versionBits = 0xff;
constexpr uint32_t otherLayouts = 0x200 | 0x800 | 0x1000; // tiles, deep pixels, several parts
// The rows of a block, by the number of the compression.
constexpr std::array<int64_t, 10> rowsOfBlock = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

struct Header {
  int64_t firstRow = 0, rows = 0, rowsAtOnce = 0;
  bool known = false; // the layout is that of scan lines, with one of the compressions above
};

[[noreturn]] void damaged(uint64_t at, std::string_view why) {
  throw BrokenFile(fmt::format("it is damaged at byte {}: {}", at, why));
}

[[noreturn]] void truncated(std::string_view bytes, std::string_view where) {
  throw BrokenFile(fmt::format("it is truncated: it ends at byte {}, {}", bytes.size(), where));
}

Header readHeader(ByteReader& reader) {
  reader.take(4); // what an OpenEXR file begins with
  const auto flags = reader.number<uint32_t>();
  if ((flags & versionBits) != version || (flags & otherLayouts)) return {};
  Header header;
  bool window = false, compression = false;
  for (auto name = reader.textBeforeZero(); !name.empty(); name = reader.textBeforeZero()) {
    reader.textBeforeZero(); // its type
    const auto size = reader.number<int32_t>();
    const uint64_t begin = reader.at();
    if (size < 0) damaged(begin - sizeof size, "a length is negative");
    const std::string_view value = reader.take(uint64_t(size));
    if (name == "dataWindow" && value.size() == 16) {
      int32_t box[4];
      std::memcpy(box, value.data(), sizeof box);
      header.firstRow = box[1];
      header.rows = int64_t(box[3]) - box[1] + 1;
      if (header.rows < 1) damaged(begin, "the picture has no rows");
      window = true;
    } else if (name == "compression" && value.size() == 1) {
      const auto kind = uint8_t(value[0]);
      if (kind >= rowsOfBlock.size()) return {};
      header.rowsAtOnce = rowsOfBlock[kind];
      compression = true;
    }
  }
  if (!window || !compression)
    damaged(reader.at(),
            fmt::format("the header before has no {}", window ? "compression" : "dataWindow"));
  header.known = true;
  return header;
}

} // namespace

uint64_t endOfExr(std::string_view bytes) {
  ByteReader reader(bytes);
  const Header header = readHeader(reader);
  if (!header.known) return bytes.size();
  const uint64_t blocks = uint64_t((header.rows + header.rowsAtOnce - 1) / header.rowsAtOnce),
                 table = reader.at();
  uint64_t end = table + blocks * sizeof(uint64_t);
  if (end > bytes.size()) truncated(bytes, "before its pixels");
  const uint64_t pixels = end;
  for (uint64_t i = 0; i < blocks; ++i) {
    constexpr uint64_t head = 2 * sizeof(int32_t); // the number of the first row, and a length
    const int64_t row = header.firstRow + int64_t(i) * header.rowsAtOnce;
    const uint64_t entry = table + i * sizeof(uint64_t);
    uint64_t place = 0;
    std::memcpy(&place, bytes.data() + entry, sizeof place);
    if (place == 0) damaged(entry, fmt::format("the pixels from row {} on are missing", row));
    if (place < pixels || place > UINT64_MAX / 2)
      damaged(entry, fmt::format("it does not lead to the pixels of row {}", row));
    int32_t is[2] = {};
    if (place + head <= bytes.size()) {
      std::memcpy(is, bytes.data() + place, sizeof is);
      if (is[0] != row || is[1] < 0)
        damaged(place, fmt::format("the pixels of row {} were expected", row));
    }
    const uint64_t last = place + head + uint64_t(is[1]);
    if (last > bytes.size())
      truncated(bytes, fmt::format("before the pixels from row {} on are complete", row));
    end = std::max(end, last);
  }
  return end;
}

} // namespace picture
