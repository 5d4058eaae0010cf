// movie.cpp: MovieTexture: clauses 6.28 and 4.6.9. The films are made here: picture i has a uniform
// grey that identifies i.
#include <cmath>

#include "conformance/events/media_files.h"
#include "image/film.h"
#include "xvrml/media.h"

#ifdef XVRML_TEST_FILMS
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}
#endif

namespace xvrml {
namespace {

std::string inShape(const std::string& fields) {
  return "Shape { appearance Appearance { texture DEF M MovieTexture { " + fields +
         " } } geometry Box {} }";
}

TEST(MovieTexture, ThatCannotBeHadHasDurationMinusOneAndItsEventsGoOn) {
  const Folder folder;
  folder.write("text.mpg", "no film at all");
  for (const char* url :
       {"none.mpg", "text.mpg", "http://a/b.mpg", "/dev/zero", "concat:a|b", "."}) {
    Browser browser(folder.world(inShape(std::string("startTime 1 url \"") + url + "\"")),
                    BrowserOptions(), 0, RunOptions{.epoch = 0});
    Node& movie = *browser.node("M");
    EXPECT_EQ(textOf(browser.get(movie, "duration_changed")), "-1") << url;
    EXPECT_EQ(browser.world().diagnostics.warnings(), 1u) << url;
    Log events;
    browser.listen(movie, "isActive",
                   [&](Node&, const FieldInfo&, const Value& v) { events.push_back(textOf(v)); });
    for (double t : {0.0, 1.0, 2.0}) browser.tick(t);
    EXPECT_EQ(events, (Log{"TRUE", "FALSE"})) << url;
    EXPECT_EQ(currentImage(movie), nullptr) << url;
  }
}

TEST(MovieTexture, WithoutUrlIsSilent) {
  const Folder folder;
  Browser browser(folder.world(inShape("loop TRUE")));
  browser.tick(1);
  EXPECT_EQ(browser.world().diagnostics.warnings(), 0u);
  EXPECT_EQ(currentImage(*browser.node("M")), nullptr);
}

#ifdef XVRML_TEST_FILMS

constexpr int pictures = 30, rate = 25, step = 6; // luma of picture i: 16 + 6 i

// Makes a film of 1.2 seconds, 64 x 48, in groups of 9 pictures with up to 2 B pictures in between
// if the codec has them.
void makeFilm(const std::string& path, const char* muxer, AVCodecID codecId) {
  AVFormatContext* format = nullptr;
  ASSERT_GE(avformat_alloc_output_context2(&format, nullptr, muxer, path.c_str()), 0) << muxer;
  const AVCodec* codec = avcodec_find_encoder(codecId);
  ASSERT_NE(codec, nullptr);
  AVCodecContext* encoder = avcodec_alloc_context3(codec);
  const bool gif = codecId == AV_CODEC_ID_GIF;
  encoder->width = 64;
  encoder->height = 48;
  encoder->time_base = {1, rate};
  encoder->framerate = {rate, 1};
  encoder->pix_fmt = gif                            ? AV_PIX_FMT_GRAY8
                     : codecId == AV_CODEC_ID_MJPEG ? AV_PIX_FMT_YUVJ420P
                                                    : AV_PIX_FMT_YUV420P;
  encoder->gop_size = 9;
  encoder->max_b_frames = codecId == AV_CODEC_ID_MPEG1VIDEO ? 2 : 0;
  encoder->bit_rate = 4'000'000;
  encoder->thread_count = 1;
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if (format->oformat->flags & AVFMT_GLOBALHEADER) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  ASSERT_GE(avcodec_open2(encoder, codec, nullptr), 0);
  AVStream* stream = avformat_new_stream(format, nullptr);
  stream->time_base = encoder->time_base;
  stream->avg_frame_rate = encoder->framerate;
  avcodec_parameters_from_context(stream->codecpar, encoder);
  ASSERT_GE(avio_open(&format->pb, path.c_str(), AVIO_FLAG_WRITE), 0);
  ASSERT_GE(avformat_write_header(format, nullptr), 0);
  AVFrame* frame = av_frame_alloc();
  frame->format = encoder->pix_fmt;
  frame->width = 64;
  frame->height = 48;
  av_frame_get_buffer(frame, 0);
  AVPacket* packet = av_packet_alloc();
  for (int i = 0; i <= pictures; ++i) {
    if (i < pictures) {
      av_frame_make_writable(frame);
      std::memset(frame->data[0], 16 + step * i, size_t(frame->linesize[0]) * 48);
      for (int plane = 1; plane < 3 && frame->data[plane]; ++plane)
        std::memset(frame->data[plane], 128, size_t(frame->linesize[plane]) * 24);
      frame->pts = i;
    }
    avcodec_send_frame(encoder, i < pictures ? frame : nullptr);
    while (avcodec_receive_packet(encoder, packet) >= 0) {
      av_packet_rescale_ts(packet, encoder->time_base, stream->time_base);
      packet->stream_index = 0;
      av_interleaved_write_frame(format, packet);
    }
  }
  av_write_trailer(format);
  avio_closep(&format->pb);
  av_packet_free(&packet);
  av_frame_free(&frame);
  avcodec_free_context(&encoder);
  avformat_free_context(format);
}

struct Kind {
  const char* name;
  const char* muxer;
  AVCodecID codec;
  bool limitedRange; // black is luma 16
};
const Kind mpeg{"film.mpg", "mpeg", AV_CODEC_ID_MPEG1VIDEO, true};

// Returns the number of the picture, from its grey; -1 if there is none.
int pictureOf(const Image* image, const Kind& kind = mpeg) {
  if (!image || image->width != 64 || image->height != 48 || image->components != 3) return -1;
  const double grey = image->pixels[(24 * 64 + 32) * 3];
  return int(std::lround((kind.limitedRange ? grey * 219 / 255 : grey - 16) / step));
}

class Film : public testing::TestWithParam<Kind> {};

TEST_P(Film, HasItsPicturesInOrderInBothDirectionsAndAtRandom) {
  const Kind& kind = GetParam();
  const Folder folder;
  makeFilm(folder / kind.name, kind.muxer, kind.codec);
  const auto film = FilmData::read(folder / kind.name, {});
  ASSERT_EQ(film->pictures(), size_t(pictures));
  EXPECT_NEAR(film->duration(), double(pictures) / rate, 1e-6);
  FilmReader reader(film, {});
  Image image;
  for (int i = 0; i < pictures; ++i) {
    ASSERT_EQ(film->pictureAt((i + 0.5) / rate), size_t(i));
    ASSERT_TRUE(reader.read(size_t(i), image));
    EXPECT_EQ(pictureOf(&image, kind), i);
  }
  for (int i = pictures; i-- > 0;) {
    ASSERT_TRUE(reader.read(size_t(i), image));
    EXPECT_EQ(pictureOf(&image, kind), i);
  }
  for (const int i : {7, 7, 29, 0, 11, 13, 12, 25, 18, 17, 9, 8}) {
    ASSERT_TRUE(reader.read(size_t(i), image));
    EXPECT_EQ(pictureOf(&image, kind), i);
  }
}

TEST_P(Film, CutOffOrDamagedIsRefusedOrShownAsFarAsItGoes) {
  const Kind& kind = GetParam();
  const Folder folder;
  makeFilm(folder / kind.name, kind.muxer, kind.codec);
  std::ifstream in(folder / kind.name, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (size_t n = 0; n < 40; ++n) {
    std::string bad = n % 2 ? whole.substr(0, whole.size() * n / 40) : whole;
    for (size_t i = 0; n % 2 == 0 && i < 20; ++i)
      bad[(n * 7919 + i * 104729) % bad.size()] ^= char(1 << i % 8);
    folder.write("bad", bad);
    Image image;
    try {
      const auto film = FilmData::read(folder / "bad", {});
      FilmReader reader(film, {});
      for (size_t i = 0; i < film->pictures(); i += 5) reader.read(i, image);
      EXPECT_LE(image.width, 4096);
    } catch (const std::runtime_error& error) { EXPECT_NE(std::string(error.what()), ""); }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Film,
    testing::Values(mpeg, Kind{"film.m1v", "mpeg1video", AV_CODEC_ID_MPEG1VIDEO, true},
                    Kind{"film.avi", "avi", AV_CODEC_ID_MPEG4, true},
                    Kind{"film.mov", "mov", AV_CODEC_ID_MJPEG, false},
                    Kind{"film.gif", "gif", AV_CODEC_ID_GIF, false}),
    [](const auto& info) { return std::string(info.param.name).substr(5); });

TEST(FilmLimits, PicturesBeyondTheLimitAreRefused) {
  const Folder folder;
  makeFilm(folder / "film.mpg", "mpeg", AV_CODEC_ID_MPEG1VIDEO);
  Limits limits;
  limits.imagePixels = 64 * 48 - 1;
  EXPECT_THROW(FilmData::read(folder / "film.mpg", limits), std::runtime_error);
}

// A world with the MPEG-1 film as texture M.
struct Movie {
  explicit Movie(const std::string& fields) {
    makeFilm(folder / "film.mpg", "mpeg", AV_CODEC_ID_MPEG1VIDEO);
    browser = std::make_unique<Browser>(folder.world(inShape("url \"film.mpg\" " + fields)),
                                        BrowserOptions(), 0, RunOptions{.epoch = 0});
    browser->listen(node(), "isActive", [this](Node&, const FieldInfo&, const Value& value) {
      events.push_back(fmt::format("{:g} {}", browser->now(), textOf(value)));
    });
    browser->takeChanges();
  }
  Node& node() { return *browser->node("M"); }
  int at(double time) {
    browser->tick(time);
    return pictureOf(currentImage(node()));
  }
  Folder folder;
  Log events;
  std::unique_ptr<Browser> browser;
};

TEST(MovieTexture, TellsItsDurationWhateverItsSpeed) {
  Movie m("speed 2");
  EXPECT_EQ(textOf(m.browser->get(m.node(), "duration_changed")), "1.2");
}

TEST(MovieTexture, ShowsItsFirstPictureBeforeItStarts) {
  Movie m("startTime 5");
  EXPECT_EQ(m.at(1), 0);
}

TEST(MovieTexture, ShowsItsLastPictureBeforeItStartsBackwards) {
  Movie m("startTime 5 speed -1");
  EXPECT_EQ(m.at(1), pictures - 1);
}

// ISO/IEC 19775-1 8.2.4
TEST(MovieTexture, StandsStillWhileItIsPaused) {
  Movie m("startTime 1 pauseTime 1.21 resumeTime 2.21");
  EXPECT_EQ(m.at(1), 0);
  EXPECT_EQ(m.at(1.5), 5);
  EXPECT_EQ(m.at(2), 5);
  EXPECT_EQ(m.at(2.51), 12);
  EXPECT_EQ(m.at(4), 29);
  m.at(5);
  EXPECT_EQ(m.events, (Log{"1 TRUE", "4 FALSE"}));
}

TEST(MovieTexture, PlaysOnceAndKeepsItsLastPicture) {
  Movie m("startTime 1");
  EXPECT_EQ(m.at(1), 0);
  EXPECT_EQ(m.at(1.5), 12);
  EXPECT_EQ(m.at(2.18), 29);
  EXPECT_EQ(m.at(3), 29);
  EXPECT_EQ(m.at(4), 29);
  EXPECT_EQ(m.events, (Log{"1 TRUE", "3 FALSE"}));
}

TEST(MovieTexture, LoopsWithTheFirstPictureAgainAtTheExactEnd) {
  Movie m("startTime 1 loop TRUE");
  EXPECT_EQ(m.at(1), 0);
  EXPECT_EQ(m.at(1 + 1.2), 0);
  EXPECT_EQ(m.at(2.71), 12);
  EXPECT_EQ(m.events, Log{"1 TRUE"});
}

TEST(MovieTexture, PlaysFasterBackwardsOrNotAtAllBySpeed) {
  Movie fast("startTime 1 speed 2"), back("startTime 1 speed -1"),
      still("startTime 1 speed 0 stopTime 9");
  EXPECT_EQ(fast.at(1.25), 12);
  EXPECT_EQ(fast.at(1.6), 29);
  EXPECT_EQ(fast.events, (Log{"1.25 TRUE", "1.6 FALSE"}));
  EXPECT_EQ(back.at(1), 29);
  EXPECT_EQ(back.at(1.42), 19);
  EXPECT_EQ(back.at(2.2), 0);
  EXPECT_EQ(still.at(1), 0);
  EXPECT_EQ(still.at(5), 0);
  EXPECT_EQ(still.at(9), 0);
  EXPECT_EQ(still.events, (Log{"1 TRUE", "9 FALSE"}));
}

TEST(MovieTexture, KeepsThePictureOfItsStopTime) {
  Movie m("startTime 1 stopTime 1.5 loop TRUE");
  m.at(1);
  EXPECT_EQ(m.at(1.9), 12);
  EXPECT_EQ(m.at(5), 12);
}

TEST(MovieTexture, IgnoresSetSpeedWhileActive) {
  Movie m("startTime 1");
  m.at(1);
  m.browser->set(m.node(), "set_speed", 3.0f);
  EXPECT_EQ(textOf(m.browser->get(m.node(), "speed")), "1");
  m.at(3);
  m.browser->set(m.node(), "set_speed", 3.0f);
  EXPECT_EQ(textOf(m.browser->get(m.node(), "speed")), "3");
}

TEST(MovieTexture, ReportsAChangeOfUrlOnlyWhenItShowsAnotherPicture) {
  Movie m("startTime 1");
  m.at(1);
  EXPECT_TRUE(m.browser->takeChanges().empty());
  m.at(1.03); // still the first picture, which lasts 40 ms
  EXPECT_TRUE(m.browser->takeChanges().empty());
  m.at(1.05);
  const FieldChanges changes = m.browser->takeChanges();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].field->name, "url");
}

TEST(MovieTexture, AnotherUrlTellsItsDuration) {
  Movie m("");
  m.browser->set(m.node(), "set_url", MFString{"none.mpg"});
  EXPECT_EQ(textOf(m.browser->get(m.node(), "duration_changed")), "-1");
  EXPECT_EQ(currentImage(m.node()), nullptr);
  m.browser->set(m.node(), "set_url", MFString{"film.mpg"});
  EXPECT_EQ(textOf(m.browser->get(m.node(), "duration_changed")), "1.2");
  EXPECT_EQ(pictureOf(currentImage(m.node())), 0);
}

TEST(MovieTexture, TheSameTimesShowTheSameBytes) {
  const auto run = [] {
    Movie m("startTime 1");
    std::vector<uint8_t> all;
    for (double t : {1.0, 1.3, 1.1, 2.0}) {
      m.at(t);
      const Image* image = currentImage(m.node());
      all.insert(all.end(), image->pixels.begin(), image->pixels.end());
    }
    return all;
  };
  EXPECT_EQ(run(), run());
}

#endif

} // namespace
} // namespace xvrml
