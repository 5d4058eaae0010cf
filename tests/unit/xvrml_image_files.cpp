// xvrml_image_files.cpp: writes the pictures that the image tests read, with the encoders of the
// image libraries.
#include <gif_lib.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <jpeglib.h>

#include "unit/picture_files.h"

namespace xvrml::test {
namespace {

void appendPng(png_structp png, png_bytep data, size_t count) {
  auto* out = static_cast<Bytes*>(png_get_io_ptr(png));
  out->insert(out->end(), data, data + count);
}

int appendGif(GifFileType* gif, const GifByteType* data, int count) {
  auto* out = static_cast<Bytes*>(gif->UserData);
  out->insert(out->end(), data, data + count);
  return count;
}

void require(bool fine) {
  if (!fine) throw std::runtime_error("cannot make the picture");
}

} // namespace

Bytes makePng(int width, int height, const PngKind& kind, const Sample& sample) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, appendPng, nullptr);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), kind.bitDepth, kind.colorType,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind.colorType == PNG_COLOR_TYPE_PALETTE) {
    std::vector<png_color> palette(size_t(1) << kind.bitDepth);
    for (size_t i = 0; i < palette.size(); i++)
      palette[i] = {png_byte(i), png_byte(2 * i), png_byte(3 * i)};
    png_set_PLTE(png, info, palette.data(), int(palette.size()));
    if (!kind.paletteAlpha.empty())
      png_set_tRNS(png, info, kind.paletteAlpha.data(), int(kind.paletteAlpha.size()), nullptr);
  }
  if (kind.transparentGrey >= 0) {
    png_color_16 grey{};
    grey.gray = png_uint_16(kind.transparentGrey);
    png_set_tRNS(png, info, nullptr, 0, &grey);
  }
  png_write_info(png, info);
  if (kind.bitDepth < 8) png_set_packing(png);
  int channels = png_get_channels(png, info), bytes = kind.bitDepth == 16 ? 2 : 1;
  std::vector<std::vector<png_byte>> rows;
  std::vector<png_bytep> pointers;
  for (int y = 0; y < height; y++) {
    rows.emplace_back();
    for (int x = 0; x < width; x++)
      for (int c = 0; c < channels; c++) {
        uint16_t value = sample(x, y, c);
        if (bytes == 2) rows.back().push_back(png_byte(value >> 8));
        rows.back().push_back(png_byte(value));
      }
  }
  for (auto& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

Bytes makeJpeg(int width, int height, int components, bool progressive, const Sample& sample) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = JDIMENSION(width);
  jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = components;
  jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(size_t(width) * size_t(components));
  for (int y = 0; y < height; y++) {
    for (int x = 0; x < width; x++)
      for (int c = 0; c < components; c++)
        row[size_t(x * components + c)] = JSAMPLE(sample(x, y, c));
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  Bytes out(memory, memory + size);
  std::free(memory);
  return out;
}

Bytes makeGif(int width, int height, const std::vector<GifFrame>& frames, const Sample& sample) {
  Bytes out;
  int error = 0;
  GifFileType* gif = EGifOpen(&out, appendGif, &error);
  require(gif);
  EGifSetGifVersion(gif, true);
  ColorMapObject* map = GifMakeMapObject(64, nullptr);
  for (int i = 0; i < 64; i++)
    map->Colors[i] = {GifByteType(i), GifByteType(2 * i), GifByteType(3 * i)};
  ColorMapObject* own = GifMakeMapObject(64, nullptr);
  for (int i = 0; i < 64; i++) own->Colors[i] = {GifByteType(255 - i), 0, 0};
  require(EGifPutScreenDesc(gif, width, height, 8, 0, map) == GIF_OK);
  for (const GifFrame& frame : frames) {
    int w = frame.width ? frame.width : width, h = frame.height ? frame.height : height;
    if (frame.transparent >= 0) {
      GraphicsControlBlock control{DISPOSAL_UNSPECIFIED, false, 0, frame.transparent};
      GifByteType block[4];
      EGifGCBToExtension(&control, block);
      require(EGifPutExtension(gif, GRAPHICS_EXT_FUNC_CODE, 4, block) == GIF_OK);
    }
    require(EGifPutImageDesc(gif, frame.left, frame.top, w, h, frame.interlaced,
                             frame.ownPalette ? own : nullptr) == GIF_OK);
    auto put = [&](int y) {
      std::vector<GifPixelType> row;
      for (int x = 0; x < w; x++) row.push_back(GifPixelType(sample(x, y, 0)));
      require(EGifPutLine(gif, row.data(), w) == GIF_OK);
    };
    static constexpr int starts[] = {0, 4, 2, 1}, steps[] = {8, 8, 4, 2};
    for (int pass = 0; pass < (frame.interlaced ? 4 : 1); pass++)
      for (int y = frame.interlaced ? starts[pass] : 0; y < h;
           y += frame.interlaced ? steps[pass] : 1)
        put(y);
  }
  EGifCloseFile(gif, &error);
  GifFreeMapObject(map);
  GifFreeMapObject(own);
  return out;
}

} // namespace xvrml::test
