#include "edit/gzip.h"

#include <algorithm>
#include <new>

#include <zlib.h>

namespace xvrml {

std::string packed(std::string_view text) {
  z_stream stream{};
  // 15 bits of window and a header of gzip.
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string out;
  char buffer[1 << 15];
  int status = Z_OK;
  do {
    const size_t step = std::min<size_t>(text.size(), size_t(1) << 30);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(step);
    text.remove_prefix(step);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(buffer);
      stream.avail_out = uInt(sizeof buffer);
      status = deflate(&stream, text.empty() ? Z_FINISH : Z_NO_FLUSH);
      out.append(buffer, sizeof buffer - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (status != Z_STREAM_END);
  deflateEnd(&stream);
  return out;
}

} // namespace xvrml
