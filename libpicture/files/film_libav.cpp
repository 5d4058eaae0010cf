// film_libav.cpp: Encodes MP4 (H.264, or MPEG-4 if the libraries have no H.264 encoder) and WebM
// (VP9 or VP8) in memory with the ffmpeg libraries.
#include "libpicture/files/film.h"

#ifndef PICTURE_WITH_FFMPEG

namespace picture {

std::unique_ptr<FilmEncoder> makeLibavEncoder(FilmKind, int, int, double, const std::string&) {
  return nullptr;
}
bool libavEncodes(FilmKind) { return false; }

} // namespace picture

#else

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace picture {

namespace {

struct Deleter {
  void operator()(AVFormatContext* c) const { avformat_free_context(c); }
  void operator()(AVIOContext* c) const {
    av_freep(&c->buffer);
    avio_context_free(&c);
  }
  void operator()(AVCodecContext* c) const { avcodec_free_context(&c); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* f) const { av_frame_free(&f); }
  void operator()(SwsContext* s) const { sws_freeContext(s); }
};
template <class T> using Owned = std::unique_ptr<T, Deleter>;

struct Codec {
  const char* encoder; // the library's name for the encoder
  const char* options; // options of the encoder: constant quality without visible blocks
};
constexpr Codec mp4Codecs[] = {{"libx264", "crf=18"}, {"libopenh264", ""}, {"mpeg4", ""}};
constexpr Codec webmCodecs[] = {{"libvpx-vp9", "crf=24:b=0"}, {"libvpx", "crf=10:b=8000000"}};

const Codec* codecOf(FilmKind kind) {
  const auto first = [](std::span<const Codec> codecs) -> const Codec* {
    for (const Codec& codec : codecs)
      if (avcodec_find_encoder_by_name(codec.encoder)) return &codec;
    return nullptr;
  };
  if (kind == FilmKind::mp4) return first(mp4Codecs);
  return kind == FilmKind::webm ? first(webmCodecs) : nullptr;
}

int check(int code, const char* what) {
  if (code >= 0) return code;
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof text);
  throw std::runtime_error(fmt::format("the ffmpeg libraries: {}: {}", what, text));
}

template <class T> T* made(T* pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

// A seekable file in memory. Muxers seek back to fill in fields that are known only at the end.
struct Memory {
  std::string bytes;
  size_t at = 0;

  static int write(void* opaque, uint8_t* data, int count) {
    Memory& file = *static_cast<Memory*>(opaque);
    try {
      file.bytes.resize(std::max(file.bytes.size(), file.at + size_t(count)));
    } catch (const std::exception&) { return AVERROR(ENOMEM); }
    std::memcpy(file.bytes.data() + file.at, data, size_t(count));
    file.at += size_t(count);
    return count;
  }
  static int64_t seek(void* opaque, int64_t offset, int whence) {
    Memory& file = *static_cast<Memory*>(opaque);
    if (whence == AVSEEK_SIZE) return int64_t(file.bytes.size());
    const int64_t from = whence == SEEK_SET   ? 0
                         : whence == SEEK_CUR ? int64_t(file.at)
                                              : int64_t(file.bytes.size());
    if (from + offset < 0) return AVERROR(EINVAL);
    file.at = size_t(from + offset);
    return int64_t(file.at);
  }
};

class LibavEncoder : public FilmEncoder {
 public:
  LibavEncoder(FilmKind kind, int width, int height, double fps, const std::string& note)
      : width_(width), height_(height), row_(size_t(width) * 3) {
    av_log_set_level(AV_LOG_QUIET); // a library must not print
    const Codec& codec = *codecOf(kind);
    AVFormatContext* format = nullptr;
    check(avformat_alloc_output_context2(&format, nullptr, kind == FilmKind::mp4 ? "mp4" : "webm",
                                         nullptr),
          "container");
    format_.reset(format);
    constexpr int buffer = 1 << 16;
    io_.reset(made(avio_alloc_context(static_cast<unsigned char*>(made(av_malloc(buffer))), buffer,
                                      1, &memory_, nullptr, Memory::write, Memory::seek)));
    format_->pb = io_.get();
    // no dates and no versions: the same pictures give the same bytes
    format_->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
    openCodec(codec, fps);
    stream_ = made(avformat_new_stream(format_.get(), nullptr));
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "stream");
    if (!note.empty())
      check(av_dict_set(&format_->metadata, "comment", note.c_str(), 0), "metadata");
    check(avformat_write_header(format_.get(), nullptr), "header");
    openScaler();
  }

  void add(std::span<const uint8_t> rgb) override {
    check(av_frame_make_writable(frame_.get()), "frame");
    for (int y = 0; y < height_; ++y)
      std::memcpy(padded_.data() + size_t(y) * size_t(codec_->width) * 3,
                  rgb.data() + size_t(y) * row_, row_);
    const uint8_t* const planes[] = {padded_.data()};
    const int strides[] = {codec_->width * 3};
    sws_scale(scaler_.get(), planes, strides, 0, codec_->height, frame_->data, frame_->linesize);
    frame_->pts = pictures_++;
    encode(frame_.get());
  }

  std::string finish() override {
    encode(nullptr);
    check(av_write_trailer(format_.get()), "trailer");
    avio_flush(io_.get());
    check(io_->error, "container");
    return std::move(memory_.bytes);
  }

 private:
  void openCodec(const Codec& codec, double fps) {
    const AVCodec* const encoder = avcodec_find_encoder_by_name(codec.encoder);
    codec_.reset(made(avcodec_alloc_context3(encoder)));
    codec_->width = (width_ + 1) / 2 * 2;
    codec_->height = (height_ + 1) / 2 * 2;
    codec_->framerate = av_d2q(fps, 60000);
    codec_->time_base = av_inv_q(codec_->framerate);
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->thread_count = 4; // fixed, because the bytes of some encoders depend on it
    codec_->flags |= AV_CODEC_FLAG_BITEXACT;
    if (format_->oformat->flags & AVFMT_GLOBALHEADER) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    // this encoder has no named option for constant quality
    if (std::string_view(codec.encoder) == "mpeg4") {
      codec_->flags |= AV_CODEC_FLAG_QSCALE;
      codec_->global_quality = 3 * FF_QP2LAMBDA;
    }
    AVDictionary* options = nullptr;
    check(av_dict_parse_string(&options, codec.options, "=", ":", 0), "options");
    const int opened = avcodec_open2(codec_.get(), encoder, &options);
    av_dict_free(&options);
    check(opened, codec.encoder);
  }

  // Converts red, green, blue to the film's colours (ITU-R BT.709, 16 to 235).
  void openScaler() {
    scaler_.reset(made(sws_getContext(codec_->width, codec_->height, AV_PIX_FMT_RGB24,
                                      codec_->width, codec_->height, AV_PIX_FMT_YUV420P,
                                      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr,
                                      nullptr, nullptr)));
    const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    padded_.resize(size_t(codec_->width) * size_t(codec_->height) * 3);
    packet_.reset(made(av_packet_alloc()));
    frame_.reset(made(av_frame_alloc()));
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    check(av_frame_get_buffer(frame_.get(), 0), "frame");
  }

  // Sends a picture to the encoder (null: end of the film) and writes the packets that are ready.
  void encode(const AVFrame* frame) {
    check(avcodec_send_frame(codec_.get(), frame), "encoder");
    for (;;) {
      const int got = avcodec_receive_packet(codec_.get(), packet_.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check(got, "encoder");
      packet_->stream_index = stream_->index;
      if (packet_->duration == 0) packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      check(av_interleaved_write_frame(format_.get(), packet_.get()), "container");
    }
  }

  int width_, height_;
  size_t row_; // bytes per row
  int64_t pictures_ = 0;
  Memory memory_;
  Owned<AVIOContext> io_;
  Owned<AVFormatContext> format_;
  Owned<AVCodecContext> codec_;
  Owned<SwsContext> scaler_;
  Owned<AVPacket> packet_;
  Owned<AVFrame> frame_;
  std::vector<uint8_t> padded_; // the picture with even width and height
  AVStream* stream_ = nullptr;  // owned by format_
};

} // namespace

std::unique_ptr<FilmEncoder> makeLibavEncoder(FilmKind kind, int width, int height, double fps,
                                              const std::string& note) {
  return std::make_unique<LibavEncoder>(kind, width, height, fps, note);
}

bool libavEncodes(FilmKind kind) { return codecOf(kind) != nullptr; }

} // namespace picture

#endif
