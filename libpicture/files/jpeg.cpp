// jpeg.cpp: Encodes JPEG with libjpeg in memory, colours at full resolution; files with quality 95.
// [any thread]
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <jpeglib.h>

#include "libpicture/files/formats.h"

namespace picture {

namespace {

struct ErrorManager {
  jpeg_error_mgr base;
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX];
};

void fail(j_common_ptr info) {
  auto* manager = reinterpret_cast<ErrorManager*>(info->err);
  info->err->format_message(info, manager->message);
  std::longjmp(manager->escape, 1);
}

void silent(j_common_ptr, int) {}

// Returns false on an error, with errors.message set. Holds only C values across libjpeg's longjmp.
bool write(ErrorManager& errors, const uint8_t* bytes, int width, int height, int quality,
           const std::string& note, unsigned char** out, unsigned long* size) {
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = fail;
  errors.base.emit_message = silent;
  if (setjmp(errors.escape)) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, out, size);
  info.image_width = JDIMENSION(width);
  info.image_height = JDIMENSION(height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  // no chroma subsampling: thin coloured lines survive
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&info, TRUE);
  if (!note.empty())
    jpeg_write_marker(&info, JPEG_COM, reinterpret_cast<const JOCTET*>(note.data()),
                      unsigned(note.size()));
  while (info.next_scanline < info.image_height) {
    // libjpeg does not change the row.
    auto* row = const_cast<JSAMPROW>(bytes + size_t(info.next_scanline) * size_t(width) * 3);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

} // namespace

std::string jpegOf(const std::vector<uint8_t>& rgb, int width, int height, int quality,
                   const std::string& note) {
  ErrorManager errors;
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const bool done = write(errors, rgb.data(), width, height, quality, note, &data, &size);
  std::string out;
  if (done) out.assign(reinterpret_cast<char*>(data), size);
  std::free(data);
  if (!done) throw std::runtime_error(std::string("JPEG: ") + errors.message);
  return out;
}

std::string encodeJpeg(const Picture& picture) {
  return jpegOf(displayBytes(picture), picture.width, picture.height, 95, picture.note);
}

} // namespace picture
