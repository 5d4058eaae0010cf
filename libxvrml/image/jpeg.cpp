// jpeg.cpp: decodes JPEG with libjpeg. Its errors return by longjmp, so functions that an error may
// leave have no objects with destructors.
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>
// jerror.h needs jpeglib.h before it.
#include <jerror.h>

#include <csetjmp>

#include "image/decoders.h"

namespace xvrml {
namespace {

struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = "";
  Image image;
  std::vector<uint8_t> row;
  bool tooLarge = false;
  bool cmyk = false;

  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

JpegReader* readerOf(j_common_ptr jpeg) { return static_cast<JpegReader*>(jpeg->client_data); }

[[noreturn]] void onError(j_common_ptr jpeg) {
  JpegReader* reader = readerOf(jpeg);
  jpeg->err->format_message(jpeg, reader->message);
  std::longjmp(reader->escape, 1);
}

// libjpeg fills missing data with grey; a damaged picture is refused instead.
void onMessage(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  int code = jpeg->err->msg_code;
  if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE ||
      code == JWRN_ARITH_BAD_CODE || code == JWRN_BOGUS_PROGRESSION)
    onError(jpeg);
}

// A small file can contain very many scans, each as slow as the whole picture.
void onProgress(j_common_ptr jpeg) {
  if (jpeg->is_decompressor && reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > 500) {
    JpegReader* reader = readerOf(jpeg);
    std::snprintf(reader->message, sizeof reader->message, "too many scans");
    std::longjmp(reader->escape, 1);
  }
}

bool readHeader(JpegReader& reader, std::span<const uint8_t> bytes) {
  if (setjmp(reader.escape)) return false;
  jpeg_create_decompress(&reader.jpeg);
  jpeg_mem_src(&reader.jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&reader.jpeg, TRUE);
  switch (reader.jpeg.jpeg_color_space) {
  case JCS_GRAYSCALE: reader.jpeg.out_color_space = JCS_GRAYSCALE; break;
  case JCS_CMYK:
  case JCS_YCCK:
    reader.jpeg.out_color_space = JCS_CMYK;
    reader.cmyk = true;
    break;
  default: reader.jpeg.out_color_space = JCS_RGB;
  }
  return true;
}

bool start(JpegReader& reader) {
  if (setjmp(reader.escape)) return false;
  reader.progress.progress_monitor = onProgress;
  reader.jpeg.progress = &reader.progress;
  jpeg_start_decompress(&reader.jpeg);
  return true;
}

// Reads one row into reader.row.
bool readRow(JpegReader& reader) {
  if (setjmp(reader.escape)) return false;
  JSAMPROW row = reader.row.data();
  if (jpeg_read_scanlines(&reader.jpeg, &row, 1) != 1) {
    std::snprintf(reader.message, sizeof reader.message, "the file ends early");
    return false;
  }
  return true;
}

void appendRow(JpegReader& reader) {
  auto& pixels = reader.image.pixels;
  if (!reader.cmyk) {
    pixels.insert(pixels.end(), reader.row.begin(), reader.row.end());
    return;
  }
  // Converts ink to light. Adobe programs store it inverted and mark the file.
  bool inverted = reader.jpeg.saw_Adobe_marker;
  for (size_t x = 0; x + 3 < reader.row.size(); x += 4) {
    auto light = [&](size_t i) {
      return unsigned(inverted ? reader.row[x + i] : 255 - reader.row[x + i]);
    };
    for (size_t i = 0; i < 3; i++) pixels.push_back(uint8_t((light(i) * light(3) + 127) / 255));
  }
}

} // namespace

Image decodeJpeg(std::span<const uint8_t> bytes, const ImageRoom& room) {
  JpegReader reader;
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = onError;
  reader.errors.emit_message = onMessage;
  reader.jpeg.client_data = &reader; // jpeg_create_decompress keeps it
  auto check = [&](bool fine) {
    if (!fine) throw std::runtime_error(std::string("damaged JPEG picture: ") + reader.message);
  };
  check(readHeader(reader, bytes));
  const uint64_t width = reader.jpeg.image_width, height = reader.jpeg.image_height;
  // For pictures with several scans, all coefficients are in memory, two bytes each.
  const bool scans = reader.jpeg.progressive_mode || jpeg_has_multiple_scans(&reader.jpeg);
  const uint64_t working = scans ? 2 * width * height * uint64_t(reader.jpeg.num_components) : 0;
  checkImageSize(width, height, reader.jpeg.jpeg_color_space == JCS_GRAYSCALE ? 1 : 3, working,
                 room, "JPEG");
  // A block of 8 x 8 pixels has at least one bit, except with arithmetic coding.
  if (!reader.jpeg.arith_code) checkFileSize(bytes.size(), width * height / 512, "JPEG");
  constexpr uint64_t rows = 16 << 20; // memory that libjpeg needs besides the coefficients
  reader.jpeg.mem->max_memory_to_use = long(2 * working + rows);
  check(start(reader));
  Image& image = reader.image;
  image.width = int32_t(reader.jpeg.output_width);
  image.height = int32_t(reader.jpeg.output_height);
  image.components = reader.cmyk ? 3 : reader.jpeg.output_components;
  image.pixels.reserve(size_t(image.width) * size_t(image.height) * size_t(image.components));
  reader.row.resize(size_t(image.width) * size_t(reader.jpeg.output_components));
  for (int32_t y = 0; y < image.height; y++) {
    check(readRow(reader));
    appendRow(reader);
  }
  jpeg_abort_decompress(&reader.jpeg); // a missing end marker is no error
  flipRows(image);
  return std::move(image);
}

} // namespace xvrml
