// picture_live_film.cpp: frames of a film are functions of their numbers, and no frame shows where
// a history ends.
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "libpicture/live/film_history.h"
#include "unit/picture_live_frames.h"

using namespace live_frames;
using picture::live::FilmHistory;

namespace {

constexpr int64_t period = FilmHistory::period;

// A textured plane that moves, under light that few samples have.
Picture frameOf(int64_t number, bool textured = true) {
  const auto step = uint32_t(number + 100); // frames before 0 exist, too
  return render(movingPlane(step, 0.02, textured), shotAt({0.02 * double(step), 0, 3}, step, true));
}

Picture add(FilmHistory& film, int64_t number, const Picture& frame) {
  return film.add(number, frame, cameraAt({0.02 * double(number + 100), 0, 3}));
}

std::map<int64_t, Picture> filmOf(int64_t first, int64_t last, int threads = 0) {
  FilmHistory film(threads);
  std::map<int64_t, Picture> pictures;
  for (int64_t n = first; n <= last; ++n) pictures[n] = add(film, n, frameOf(n));
  return pictures;
}

double difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (size_t i = 0; i < valuesOf(a).size(); ++i)
    sum += std::abs(double(valuesOf(a)[i]) - double(valuesOf(b)[i]));
  return sum / double(valuesOf(a).size());
}

// A frame of eight samples per pixel. Their variance tells noise from detail.
Picture frameOfEight(const World& world, Shot shot, bool hasVariance) {
  constexpr uint32_t samples = 8;
  const uint32_t number = shot.number;
  shot.number = number * samples;
  Picture frame = render(world, shot);
  std::vector<float>&rgba = frame.planes[RT_RGBA], &albedo = frame.planes[RT_ALBEDO];
  std::vector<double> sums(rgba.size()), squares(rgba.size()), albedos(albedo.size());
  for (uint32_t k = 0; k < samples; ++k) {
    shot.number = number * samples + k;
    const Picture one = render(world, shot);
    for (size_t i = 0; i < sums.size(); ++i) {
      sums[i] += double(valuesOf(one)[i]);
      squares[i] += double(valuesOf(one)[i]) * double(valuesOf(one)[i]);
    }
    for (size_t i = 0; i < albedos.size(); ++i) albedos[i] += double(one.planes.at(RT_ALBEDO)[i]);
  }
  std::vector<float> variance;
  for (size_t i = 0; i < sums.size(); ++i) {
    rgba[i] = float(sums[i] / samples);
    const double rest = squares[i] - sums[i] * sums[i] / samples;
    if (i % 4 != 3) variance.push_back(float(std::max(rest, 0.0) / (samples - 1)));
  }
  for (size_t i = 0; i < albedo.size(); ++i) albedo[i] = float(albedos[i] / samples);
  frame.planes[RT_SAMPLES].assign(frame.planes[RT_SAMPLES].size(), float(samples));
  if (hasVariance) frame.planes[RT_VARIANCE] = variance;
  return frame;
}

// Light that changes every few pixels: without noise, but as rough as noise.
World roughLight() {
  return [](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite);
    const Vec p = origin + direction * hit.distance;
    hit.light =
        random(uint32_t(int(std::floor(p.x * 22)) * 4099 + int(std::floor(p.y * 22))), 1, 2);
    hit.name = 1;
    return hit;
  };
}

// Returns how far the last of some frames is from the truth.
double errorOf(const World& world, bool noisy, bool hasVariance) {
  picture::live::Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t n = 0; n < 5; ++n) {
    shot = shotAt({0.03 * n, 0, 3}, n, noisy);
    shown = reconstruction.add(frameOfEight(world, shot, hasVariance), shot.camera);
  }
  return rms(shown, converged(world, shot), inner(shot));
}

} // namespace

TEST(LiveFilm, AFrameIsMadeOfTheFramesOfTwoHistories) {
  EXPECT_EQ(FilmHistory::firstFor(0), -period);
  EXPECT_EQ(FilmHistory::firstFor(period - 1), -period);
  EXPECT_EQ(FilmHistory::firstFor(period), 0);
  EXPECT_EQ(FilmHistory::firstFor(-1), -2 * period);
  for (int64_t n = -20; n < 20; ++n) {
    EXPECT_EQ(FilmHistory::firstFor(n) % period, 0);
    EXPECT_GE(n - FilmHistory::firstFor(n), period);
    EXPECT_LT(n - FilmHistory::firstFor(n), 2 * period);
    EXPECT_GT(FilmHistory::weightOfYounger(n), 0);
    EXPECT_LT(FilmHistory::weightOfYounger(n), 1);
  }
}

TEST(LiveFilm, AFrameAloneHasTheBytesThatItHasInTheFilm) {
  const auto whole = filmOf(-period, 20);
  for (const int64_t n : {0, 1, 7, 8, 15, 20}) {
    const auto part = filmOf(FilmHistory::firstFor(n), n);
    EXPECT_EQ(valuesOf(part.at(n)), valuesOf(whole.at(n))) << n;
  }
  EXPECT_NE(valuesOf(filmOf(FilmHistory::firstFor(20) + 1, 20).at(20)), valuesOf(whole.at(20)))
      << "all of its frames count";
}

// A part of a film that begins anew knows nothing of what has moved before.
TEST(LiveFilm, TheMotionOfTheFirstFrameDoesNotCount) {
  const auto with = [](float motion) {
    FilmHistory film;
    Picture first = frameOf(0);
    first.planes[RT_MOTION].assign(first.planes[RT_MOTION].size(), motion);
    add(film, 0, first);
    return add(film, 1, frameOf(1));
  };
  const Picture known = with(0.02f);
  EXPECT_EQ(valuesOf(with(0)), valuesOf(known));
  EXPECT_EQ(valuesOf(with(std::numeric_limits<float>::quiet_NaN())), valuesOf(known));
}

TEST(LiveFilm, AGapBeginsAnew) {
  const auto whole = filmOf(0, 18);
  FilmHistory film;
  for (int64_t n = 40; n < 43; ++n) add(film, n, frameOf(n));
  for (int64_t n = 0; n <= 18; ++n) {
    const Picture picture = add(film, n, frameOf(n));
    EXPECT_EQ(valuesOf(picture), valuesOf(whole.at(n))) << n;
  }
}

TEST(LiveFilm, TheSameBytesOnAnyNumberOfThreads) {
  EXPECT_EQ(valuesOf(filmOf(0, 10, 1).at(10)), valuesOf(filmOf(0, 10, 3).at(10)));
}

// Where a history ends, pictures change no more than elsewhere.
TEST(LiveFilm, NoFrameShowsThatAHistoryEnds) {
  FilmHistory film;
  double seams = 0, others = 0;
  Picture before;
  constexpr int64_t last = 6 * period;
  for (int64_t n = 0; n <= last; ++n) {
    Shot shot = shotAt({0, 0, 3}, uint32_t(n), true); // at rest: all changes are noise
    const Picture picture = film.add(n, render(movingPlane(0, 0, false), shot), shot.camera);
    if (n > 2 * period) (n % period == 0 ? seams : others) += difference(picture, before);
    before = picture;
  }
  seams /= 4;
  others /= double(last - 2 * period - 4);
  EXPECT_GT(others, 0);
  EXPECT_LT(seams, 1.1 * others);
}

TEST(LiveFilm, DetailThatSamplesTellFromNoiseStays) {
  const double with = errorOf(roughLight(), false, true),
               without = errorOf(roughLight(), false, false);
  EXPECT_LT(with, 0.5 * without);
}

TEST(LiveFilm, NoiseThatSamplesTellIsFilteredAsBefore) {
  const World world = [](Vec origin, Vec direction) {
    return movingPlane(0, 0, false)(origin, direction);
  };
  const double with = errorOf(world, true, true), without = errorOf(world, true, false);
  EXPECT_LT(with, 1.1 * without);
}
