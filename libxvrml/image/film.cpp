// film.cpp: reads films with ffmpeg. All compressed pictures are read into memory once. Any of them
// can then be decoded from the key picture before it, in the same way on every machine. Seeking
// within containers would be inexact.
#include "image/film.h"

#include <stdexcept>

#ifdef XVRML_WITH_FFMPEG
#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "base/regular_file.h"
#include "image/decoders.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace xvrml {
namespace {

constexpr uint64_t maximumFilmBytes = 256ull << 20; // limit for the compressed pictures of a film
constexpr size_t maximumPictures = 1'000'000;
// Limit for the pixels decoded on the way to one picture.
constexpr uint64_t maximumWork = 2'000'000'000;
// The formats and codecs of films in VRML worlds. Formats that play lists, open other files or read
// subtitles are left out.
constexpr char formats[] = "mpeg,mpegvideo,avi,mov,mp4,m4v,gif";
constexpr AVCodecID codecs[] = {
    AV_CODEC_ID_MPEG1VIDEO, AV_CODEC_ID_MPEG2VIDEO, AV_CODEC_ID_MPEG4,   AV_CODEC_ID_H264,
    AV_CODEC_ID_MJPEG,      AV_CODEC_ID_GIF,        AV_CODEC_ID_CINEPAK, AV_CODEC_ID_INDEO3,
    AV_CODEC_ID_MSVIDEO1,   AV_CODEC_ID_RAWVIDEO,   AV_CODEC_ID_SVQ1};

struct Deleter {
  void operator()(AVFormatContext* c) const { avformat_close_input(&c); }
  void operator()(AVIOContext* c) const {
    av_freep(&c->buffer);
    avio_context_free(&c);
  }
  void operator()(AVCodecContext* c) const { avcodec_free_context(&c); }
  void operator()(AVCodecParameters* p) const { avcodec_parameters_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* f) const { av_frame_free(&f); }
  void operator()(SwsContext* s) const { sws_freeContext(s); }
};
template <class T> using Owned = std::unique_ptr<T, Deleter>;

[[noreturn]] void fail(const std::string& why) { throw std::runtime_error(why); }

// Returns the limit for one picture. A decoder keeps up to 16 pictures at once, and even the
// smallest file can demand the largest size.
uint64_t maximumPixels(const Limits& limits) {
  return std::min<uint64_t>(limits.imagePixels / 16, INT32_MAX);
}

// The file that ffmpeg reads, and its position.
struct Input {
  const RegularFile& file;
  int64_t at = 0;
};

int readBytes(void* opaque, uint8_t* to, int count) {
  auto& input = *static_cast<Input*>(opaque);
  try {
    const size_t n = input.file.read(uint64_t(input.at), to, size_t(std::max(count, 0)));
    input.at += int64_t(n);
    return n > 0 ? int(n) : AVERROR_EOF;
  } catch (const std::exception&) { return AVERROR(EIO); }
}

int64_t seekBytes(void* opaque, int64_t offset, int whence) {
  auto& input = *static_cast<Input*>(opaque);
  const auto size = int64_t(input.file.size());
  whence &= ~AVSEEK_FORCE;
  if (whence == AVSEEK_SIZE) return size;
  const int64_t from = whence == SEEK_CUR ? input.at : whence == SEEK_END ? size : 0;
  if (offset < -from || offset > INT64_MAX - from) return -1;
  return input.at = from + offset;
}

int refuseOpen(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) {
  return AVERROR(EPERM);
}

// Returns the type of an MPEG-1 or MPEG-2 picture: 1 I, 2 P, 3 B; 0 if the packet holds no picture
// (ISO/IEC 11172-2 2.4.2.5).
int pictureType(const AVPacket& packet) {
  for (int i = 0; i + 5 < packet.size; ++i) {
    const uint8_t* p = packet.data + i;
    if (p[0] == 0 && p[1] == 0 && p[2] == 1 && p[3] == 0) return p[5] >> 3 & 7;
  }
  return 0;
}

} // namespace

struct FilmData::Impl {
  Owned<AVCodecParameters> parameters;
  std::vector<Owned<AVPacket>> packets; // in decoding order
  std::vector<size_t> order;            // index of each packet's picture in display order
  std::vector<bool> key;                // decoding can begin at this packet
  std::vector<double> starts; // start of each picture in seconds: begins at 0, never decreases
  double duration = 0;
  uint64_t bytes = 0; // size of the packets

  void demux(AVFormatContext& format, AVStream& stream);
  void sortMpeg();
  void sortByTime();
  void timeBy(const AVStream& stream, double rate);
};

void FilmData::Impl::demux(AVFormatContext& format, AVStream& stream) {
  for (unsigned i = 0; i < format.nb_streams; ++i)
    if (format.streams[i] != &stream) format.streams[i]->discard = AVDISCARD_ALL;
  Owned<AVPacket> packet(av_packet_alloc());
  while (packet && av_read_frame(&format, packet.get()) >= 0) {
    if (packet->stream_index != stream.index || packet->size <= 0) {
      av_packet_unref(packet.get());
      continue;
    }
    bytes += uint64_t(packet->size);
    if (bytes > maximumFilmBytes || packets.size() >= maximumPictures)
      fail("the film is too large");
    if (av_packet_make_refcounted(packet.get()) < 0) fail("no memory for the film");
    // Each picture of a GIF is drawn over the one before it.
    key.push_back(packets.empty() || (packet->flags & AV_PKT_FLAG_KEY &&
                                      stream.codecpar->codec_id != AV_CODEC_ID_GIF));
    packets.push_back(std::move(packet));
    packet.reset(av_packet_alloc());
  }
  if (packets.empty()) fail("the film has no pictures");
}

// Sorts for display: I and P pictures are shown after the B pictures that follow them in the file.
void FilmData::Impl::sortMpeg() {
  std::erase_if(packets, [](const auto& p) { return pictureType(*p) == 0; });
  if (packets.empty()) fail("the film has no pictures");
  key.assign(packets.size(), false);
  size_t shown = 0, pending = packets.size();
  order.assign(packets.size(), 0);
  for (size_t i = 0; i < packets.size(); ++i) {
    key[i] = i == 0 || pictureType(*packets[i]) == 1;
    if (pictureType(*packets[i]) == 3) {
      order[i] = shown++;
    } else {
      if (pending < packets.size()) order[pending] = shown++;
      pending = i;
    }
  }
  if (pending < packets.size()) order[pending] = shown++;
}

void FilmData::Impl::sortByTime() {
  std::vector<size_t> byTime(packets.size());
  for (size_t i = 0; i < byTime.size(); ++i) byTime[i] = i;
  const bool timed = std::all_of(packets.begin(), packets.end(),
                                 [](const auto& p) { return p->pts != AV_NOPTS_VALUE; });
  if (timed)
    std::stable_sort(byTime.begin(), byTime.end(),
                     [&](size_t a, size_t b) { return packets[a]->pts < packets[b]->pts; });
  order.assign(packets.size(), 0);
  for (size_t i = 0; i < byTime.size(); ++i) order[byTime[i]] = i;
}

// rate: pictures per second, for films without timestamps; otherwise 0.
void FilmData::Impl::timeBy(const AVStream& stream, double rate) {
  const size_t count = packets.size();
  starts.assign(count, 0);
  if (rate > 0) {
    for (size_t i = 0; i < count; ++i) starts[i] = double(i) / rate;
    duration = double(count) / rate;
    return;
  }
  int64_t first = INT64_MAX, end = 0;
  for (const auto& packet : packets) first = std::min(first, packet->pts);
  for (size_t i = 0; i < count; ++i) {
    starts[order[i]] = double(packets[i]->pts - first) * av_q2d(stream.time_base);
    end = std::max(end, packets[i]->pts - first + std::max<int64_t>(packets[i]->duration, 0));
  }
  duration = double(end) * av_q2d(stream.time_base);
}

FilmData::FilmData(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmData::~FilmData() = default;
double FilmData::duration() const { return impl_->duration; }
size_t FilmData::pictures() const { return impl_->packets.size(); }
uint64_t FilmData::bytes() const { return impl_->bytes; }

size_t FilmData::pictureAt(double seconds) const {
  const auto after = std::upper_bound(impl_->starts.begin(), impl_->starts.end(), seconds);
  return after == impl_->starts.begin() ? 0 : size_t(after - impl_->starts.begin()) - 1;
}

namespace {

std::unique_ptr<FilmData::Impl> load(const RegularFile& file, const Limits& limits) {
  Input input{file};
  constexpr int bufferBytes = 64 << 10;
  auto* buffer = static_cast<unsigned char*>(av_malloc(bufferBytes));
  Owned<AVIOContext> io(
      buffer ? avio_alloc_context(buffer, bufferBytes, 0, &input, readBytes, nullptr, seekBytes)
             : nullptr);
  AVFormatContext* context = avformat_alloc_context();
  if (!io || !context) fail("no memory for the film");
  context->pb = io.get();
  context->flags |= AVFMT_FLAG_CUSTOM_IO;
  context->io_open = refuseOpen;
  context->format_whitelist = av_strdup(formats);
  if (avformat_open_input(&context, "", nullptr, nullptr) < 0)
    fail("the file is not a film of a known kind"); // this has freed the context
  const Owned<AVFormatContext> format(context);
  {
    std::vector<AVDictionary*> options(format->nb_streams, nullptr);
    for (AVDictionary*& o : options) {
      av_dict_set_int(&o, "max_pixels", int64_t(maximumPixels(limits)), 0);
      av_dict_set_int(&o, "threads", 1, 0);
    }
    const int found =
        avformat_find_stream_info(format.get(), options.empty() ? nullptr : options.data());
    for (AVDictionary*& o : options) av_dict_free(&o);
    if (found < 0) fail("damaged film");
  }
  const int index = av_find_best_stream(format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) fail("the film has no pictures");
  AVStream& stream = *format->streams[index];
  const AVCodecID codec = stream.codecpar->codec_id;
  if (std::find(std::begin(codecs), std::end(codecs), codec) == std::end(codecs))
    fail(fmt::format("films of type {} are not decoded", avcodec_get_name(codec)));
  const auto width = uint64_t(std::max(stream.codecpar->width, 0)),
             height = uint64_t(std::max(stream.codecpar->height, 0));
  checkImageSize(width, height, limits, "film");
  if (width * height > maximumPixels(limits))
    fail(fmt::format(
        "film picture of {} x {} pixels is beyond a sixteenth of the limit 'imagePixels' ({})",
        width, height, limits.imagePixels));

  auto impl = std::make_unique<FilmData::Impl>();
  impl->parameters.reset(avcodec_parameters_alloc());
  if (!impl->parameters || avcodec_parameters_copy(impl->parameters.get(), stream.codecpar) < 0)
    fail("no memory for the film");
  double rate = av_q2d(av_guess_frame_rate(format.get(), &stream, nullptr));
  if (!(rate > 0 && rate <= 1000)) rate = 25;
  impl->demux(*format, stream);
  const bool mpeg = codec == AV_CODEC_ID_MPEG1VIDEO || codec == AV_CODEC_ID_MPEG2VIDEO;
  mpeg ? impl->sortMpeg() : impl->sortByTime();
  const bool timed = std::all_of(impl->packets.begin(), impl->packets.end(),
                                 [](const auto& p) { return p->pts != AV_NOPTS_VALUE; });
  impl->timeBy(stream, mpeg || !timed ? rate : 0);
  if (!(impl->duration > 0)) impl->timeBy(stream, rate);
  return impl;
}

} // namespace

// Films are cached, so that a film shown by many nodes is in memory once.
std::shared_ptr<const FilmData> FilmData::read(const std::string& path, const Limits& limits) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const FilmData>> films;
  av_log_set_level(AV_LOG_QUIET); // ffmpeg must not print
  const RegularFile file(path);
  const std::string key = fmt::format("{}|{}|{}", path, file.size(), file.modified());
  const std::lock_guard lock(mutex);
  std::erase_if(films, [](const auto& entry) { return entry.second.expired(); });
  if (auto known = films[key].lock()) return known;
  auto film = std::make_shared<const FilmData>(load(file, limits));
  films[key] = film;
  return film;
}

namespace {

// Drops an alpha channel that is opaque everywhere. A fourth component would override the
// Material's transparency (clause 4.14).
void dropOpaqueAlpha(Image& image) {
  const size_t count = image.pixels.size() / 4;
  for (size_t i = 0; i < count; ++i)
    if (image.pixels[4 * i + 3] != 255) return;
  for (size_t i = 0; i < count; ++i)
    std::copy_n(image.pixels.data() + 4 * i, 3, image.pixels.data() + 3 * i);
  image.pixels.resize(3 * count);
  image.components = 3;
}

} // namespace

struct FilmReader::Impl {
  std::shared_ptr<const FilmData> film;
  Limits limits;
  Owned<AVCodecContext> decoder;
  Owned<SwsContext> converter;
  Owned<AVFrame> frame{av_frame_alloc()};
  size_t next = 0;     // the packet to decode next
  size_t expected = 0; // pictures before this one can no longer be received
  bool ended = false;  // the decoder was told that no packet follows

  void seek(size_t picture);
  bool send();
  bool convert(Image& image);
};

// Continues at the decoder's present position, unless a key picture is nearer.
void FilmReader::Impl::seek(size_t picture) {
  const FilmData::Impl& data = film->impl();
  size_t from = 0;
  for (size_t i = 0; i < data.packets.size(); ++i)
    if (data.key[i] && data.order[i] <= picture) from = i;
  if (!ended && picture >= expected && from <= next) return;
  avcodec_flush_buffers(decoder.get());
  next = from;
  expected = 0;
  ended = false;
}

// Sends the decoder the next packet, or the end of the film. Returns false if it accepts no more.
bool FilmReader::Impl::send() {
  const FilmData::Impl& data = film->impl();
  if (ended) return false;
  if (next >= data.packets.size()) {
    ended = true;
    return avcodec_send_packet(decoder.get(), nullptr) >= 0;
  }
  const Owned<AVPacket> packet(av_packet_clone(data.packets[next].get()));
  if (!packet) return false;
  packet->pts = int64_t(data.order[next++]);
  packet->dts = AV_NOPTS_VALUE;
  avcodec_send_packet(decoder.get(), packet.get()); // a damaged picture is skipped
  return true;
}

bool FilmReader::Impl::convert(Image& image) {
  const int width = frame->width, height = frame->height;
  if (width <= 0 || height <= 0 || uint64_t(width) * uint64_t(height) > maximumPixels(limits))
    return false;
  const auto source = AVPixelFormat(frame->format);
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(source);
  const bool alpha = description && description->flags & AV_PIX_FMT_FLAG_ALPHA;
  const AVPixelFormat target = alpha ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
  constexpr int flags =
      SWS_BILINEAR | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_ACCURATE_RND | SWS_BITEXACT;
  converter.reset(sws_getCachedContext(converter.release(), width, height, source, width, height,
                                       target, flags, nullptr, nullptr, nullptr));
  uint8_t* planes[4] = {};
  int strides[4] = {};
  if (!converter || av_image_alloc(planes, strides, width, height, target, 64) < 0) return false;
  sws_scale(converter.get(), frame->data, frame->linesize, 0, height, planes, strides);
  const int components = alpha ? 4 : 3;
  image.width = width;
  image.height = height;
  image.components = components;
  const size_t row = size_t(width) * size_t(components);
  image.pixels.resize(row * size_t(height));
  for (int y = 0; y < height; ++y)
    std::copy_n(planes[0] + ptrdiff_t(strides[0]) * y, row,
                image.pixels.data() + row * size_t(height - 1 - y));
  av_freep(&planes[0]);
  if (alpha) dropOpaqueAlpha(image);
  return true;
}

FilmReader::FilmReader(std::shared_ptr<const FilmData> film, const Limits& limits)
    : impl_(std::make_unique<Impl>()) {
  impl_->film = std::move(film);
  impl_->limits = limits;
  const AVCodecParameters* parameters = impl_->film->impl().parameters.get();
  const AVCodec* codec = avcodec_find_decoder(parameters->codec_id);
  impl_->decoder.reset(avcodec_alloc_context3(codec));
  AVCodecContext* decoder = impl_->decoder.get();
  if (!codec || !decoder || !impl_->frame || avcodec_parameters_to_context(decoder, parameters) < 0)
    fail("no decoder for the film");
  decoder->thread_count = 1;
  decoder->max_pixels = int64_t(maximumPixels(limits));
  decoder->flags |= AV_CODEC_FLAG_BITEXACT; // the same pictures on every machine
  decoder->idct_algo = FF_IDCT_SIMPLE;
  if (avcodec_open2(decoder, codec, nullptr) < 0) fail("no decoder for the film");
}

FilmReader::~FilmReader() = default;

bool FilmReader::read(size_t picture, Image& image) {
  Impl& r = *impl_;
  picture = std::min(picture, r.film->pictures() - 1);
  r.seek(picture);
  const uint64_t each =
      uint64_t(std::max(r.decoder->width, 1)) * uint64_t(std::max(r.decoder->height, 1));
  for (uint64_t work = 0;;) {
    const int result = avcodec_receive_frame(r.decoder.get(), r.frame.get());
    if (result == AVERROR_EOF) return false;
    if (result < 0) { // it needs the next packet, or its data is damaged
      if (work > 2 * maximumWork || !r.send()) return false;
      work += each;
      continue;
    }
    const int64_t number =
        r.frame->pts != AV_NOPTS_VALUE ? r.frame->pts : r.frame->best_effort_timestamp;
    r.expected = size_t(std::max<int64_t>(number, 0)) + 1;
    if (r.expected > picture || work > maximumWork) return r.convert(image);
  }
}

bool decodesFilms() { return true; }

} // namespace xvrml

#else // no ffmpeg libraries

namespace xvrml {

struct FilmData::Impl {};
struct FilmReader::Impl {};

FilmData::FilmData(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmData::~FilmData() = default;
double FilmData::duration() const { return 0; }
size_t FilmData::pictures() const { return 0; }
uint64_t FilmData::bytes() const { return 0; }
size_t FilmData::pictureAt(double) const { return 0; }
std::shared_ptr<const FilmData> FilmData::read(const std::string&, const Limits&) {
  throw std::runtime_error("this build has no decoder of films (the ffmpeg libraries were absent)");
}
FilmReader::FilmReader(std::shared_ptr<const FilmData>, const Limits&) {}
FilmReader::~FilmReader() = default;
bool FilmReader::read(size_t, Image&) { return false; }
bool decodesFilms() { return false; }

} // namespace xvrml
#endif
