#include "libpicture/files/exr_end.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

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

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes) {}

  Header read() {
    take(4); // what an OpenEXR file begins with
    const auto flags = number<uint32_t>();
    if ((flags & versionBits) != version || (flags & otherLayouts)) return {};
    Header header;
    bool window = false, compression = false;
    for (std::string_view name = text(); !name.empty(); name = text()) {
      text(); // its type
      const auto size = number<int32_t>();
      if (size < 0) damaged(at_ - sizeof size, "a length is negative");
      const size_t begin = at_;
      const std::string_view value = take(size_t(size));
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
      damaged(at_,
              fmt::format("the header before has no {}", window ? "compression" : "dataWindow"));
    header.known = true;
    return header;
  }

  size_t position() const { return at_; }

  [[noreturn]] static void damaged(uint64_t at, std::string_view why) {
    throw BrokenExr(fmt::format("it is damaged at byte {}: {}", at, why));
  }

 private:
  std::string_view take(size_t size) {
    if (size > bytes_.size() - at_)
      throw BrokenExr(
          fmt::format("it is truncated: it ends at byte {}, in its header", bytes_.size()));
    const std::string_view taken = bytes_.substr(at_, size);
    at_ += size;
    return taken;
  }
  template <class T> T number() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view text() {
    const size_t end = std::min(bytes_.find('\0', at_), bytes_.size());
    const std::string_view found = take(end - at_);
    take(1);
    return found;
  }

  std::string_view bytes_;
  size_t at_ = 0;
};

} // namespace

uint64_t endOfExr(std::string_view bytes) {
  HeaderReader reader(bytes);
  const Header header = reader.read();
  if (!header.known) return bytes.size();
  const uint64_t blocks = uint64_t((header.rows + header.rowsAtOnce - 1) / header.rowsAtOnce),
                 table = reader.position();
  uint64_t end = table + blocks * sizeof(uint64_t);
  if (end > bytes.size())
    throw BrokenExr(
        fmt::format("it is truncated: it ends at byte {}, before its pixels", bytes.size()));
  const uint64_t pixels = end;
  for (uint64_t i = 0; i < blocks; ++i) {
    constexpr uint64_t head = 2 * sizeof(int32_t); // the number of the first row, and a length
    const int64_t row = header.firstRow + int64_t(i) * header.rowsAtOnce;
    const uint64_t entry = table + i * sizeof(uint64_t);
    uint64_t place = 0;
    std::memcpy(&place, bytes.data() + entry, sizeof place);
    if (place == 0)
      reader.damaged(entry, fmt::format("the pixels from row {} on are missing", row));
    if (place < pixels || place > UINT64_MAX / 2)
      reader.damaged(entry, fmt::format("it does not lead to the pixels of row {}", row));
    int32_t is[2] = {};
    if (place + head <= bytes.size()) {
      std::memcpy(is, bytes.data() + place, sizeof is);
      if (is[0] != row || is[1] < 0)
        reader.damaged(place, fmt::format("the pixels of row {} were expected", row));
    }
    const uint64_t last = place + head + uint64_t(is[1]);
    if (last > bytes.size())
      throw BrokenExr(fmt::format("it is truncated: it ends at byte {}, before the pixels from row "
                                  "{} on are complete",
                                  bytes.size(), row));
    end = std::max(end, last);
  }
  return end;
}

} // namespace picture
