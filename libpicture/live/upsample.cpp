// upsample.cpp: Accumulates the colours of frames in a picture that may have more pixels than they
// have samples. Each sample counts for the pixel that it lies in. The other pixels keep what they
// have shown, which follows the motion of the surface that they show; before its first sample, a
// pixel shows what lies around it. Samples lie at random places, so the mean over the frames
// smooths edges and textures, too, as more samples in one frame would.
//
// Each pixel of the picture decides by its own history how it moves, and not only by the sample
// next to it, which may have hit something else.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/upsample.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/shown-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// Frames that are accumulated: where nothing moves; where nothing moves but light is sampled, which
// may change; and elsewhere, where each frame blurs a little what was accumulated.
constexpr float framesAtRest = 256, framesSampled = 16, framesMoving = 4;
// A pixel that a sample lies in only now and then keeps at least as many samples.
constexpr float fewestSamples = 2;
// Neighbours of one shape lie on one side of an edge if the cosine between their normals is larger.
constexpr float sameSide = 0.9f;

// Some pixels of the shown picture, and the pixels of the frame that their colours come from.
struct Target {
  int x, y;
  size_t i;       // the place of the first one in planes
  Indices source; // the sample in the pixel, or else the frame's pixel around its centre
  Mask hit, exists;
  Mask some; // that pixel of the frame has a sample
};

// Finds the sample that lies in each pixel.
inline Target targetAt(const ShowPass& pass, const Layout& layout, int x, int y) {
  const Layout& frame = pass.pixels.layout;
  const IndicesTag tag;
  const Indices first = hn::LoadU(tag, pass.columns.first.data() + x),
                last = hn::LoadU(tag, pass.columns.last.data() + x),
                middle = hn::LoadU(tag, pass.columns.middle.data() + x);
  const int top = pass.rows.first[size_t(y)], bottom = pass.rows.last[size_t(y)];
  const auto rowOf = [&](int at) { return hn::Set(tag, int32_t(frame.row(at))); };
  Indices source = rowOf(pass.rows.middle[size_t(y)]) + middle;
  Mask hit = lanesOf(1) < lanesOf(0);
  const auto lookAt = [&](Indices at) {
    const Mask lies = hn::And(gather(pass.reading.hitX.data(), at) == countFrom(x),
                              gather(pass.reading.hitY.data(), at) == lanesOf(float(y)));
    const Mask found = hn::AndNot(hit, lies);
    source = hn::IfThenElse(hn::RebindMask(tag, found), at, source);
    hit = hn::Or(hit, lies);
  };
  const bool wide = !hn::AllTrue(tag, first == last);
  for (int row = top; row <= bottom; row++) {
    lookAt(rowOf(row) + first);
    if (wide) lookAt(rowOf(row) + last);
  }
  const Mask exists = presentFrom(x, layout.width);
  return {x,
          y,
          layout.row(y) + size_t(x),
          source,
          hn::And(hit, exists),
          exists,
          gather(pass.pixels.guides.name.data(), source) >= lanesOf(0)};
}

// The surface of a pixel of the frame, and where a pixel of the shown picture was if it shows it.
struct Candidate {
  Past past;
  Indices at; // the pixel of what was shown next to it
  Mask inside, rests;
  Expected expected;
};

inline Candidate candidateOf(const ShowPass& pass, const Layout& layout, const Target& target,
                             Indices source) {
  const Layout& old = pass.before.layout;
  const Resampling alongX(layout.width, old.width), alongY(layout.height, old.height);
  const Past past{countFrom(target.x) * lanesOf(alongX.ratio) + lanesOf(alongX.shift) +
                      gather(pass.reading.moveX.data(), source) * lanesOf(float(old.width)),
                  lanesOf(alongY(float(target.y))) +
                      gather(pass.reading.moveY.data(), source) * lanesOf(float(old.height))};
  const Mask inside = hn::And(isInside(old, past), target.exists);
  const Mask same = old == layout ? inside : hn::AndNot(inside, inside);
  const Mask rests =
      hn::And(same, hn::And(past.x == countFrom(target.x), past.y == lanesOf(float(target.y))));
  const IndicesTag tag;
  const auto nearest = [&](Lanes place) {
    return hn::ConvertTo(tag, hn::Floor(hn::IfThenElseZero(inside, place) + lanesOf(0.5f)));
  };
  const Indices border = hn::Set(tag, Layout::border);
  const Indices at =
      (nearest(past.y) + border) * hn::Set(tag, int32_t(old.stride)) + nearest(past.x) + border;
  const Guides& guides = pass.pixels.guides;
  return {past,
          at,
          inside,
          rests,
          {gather(guides.name.data(), source), gather(pass.reading.pastNearness.data(), source),
           gather(pass.fresh.tolerance.data(), source), gather(guides.normal, source)}};
}

// Returns where the surface was shown at the place of a candidate, or in at least so many of the
// nine pixels there.
inline Mask wasShown(const Shown& before, const Candidate& candidate, Mask asked, Lanes least) {
  const Mask wanted = hn::And(asked, candidate.inside);
  const Mask found = hn::And(wanted, candidate.expected.matches(before.surfaces, candidate.at));
  if (hn::AllTrue(LanesTag(), hn::Or(found, hn::Not(wanted)))) return found;
  const IndicesTag tag;
  const auto stride = int32_t(before.layout.stride);
  Lanes like = lanesOf(0);
  for (int k = 0; k < 9; k++) {
    const Indices at = candidate.at + hn::Set(tag, (k / 3 - 1) * stride + k % 3 - 1);
    like = like + hn::IfThenElseZero(candidate.expected.matches(before.surfaces, at), lanesOf(1));
  }
  return hn::Or(found, hn::And(wanted, like >= least));
}

// Tells what was shown of some pixels.
struct Origin {
  Past past;
  Indices at;     // in planes of what was shown
  Indices source; // the pixel of the frame that says so
  Mask rests, known;
};

inline void take(Origin& origin, const Candidate& candidate, Indices source, Mask which) {
  origin.past.x = select(which, candidate.past.x, origin.past.x);
  origin.past.y = select(which, candidate.past.y, origin.past.y);
  origin.rests = hn::Or(hn::And(which, candidate.rests), hn::AndNot(which, origin.rests));
  const auto indices = hn::RebindMask(IndicesTag(), which);
  origin.at = hn::IfThenElse(indices, candidate.at, origin.at);
  origin.source = hn::IfThenElse(indices, source, origin.source);
  origin.known = hn::Or(origin.known, which);
}

// Finds where pixels were shown: with what is in front, if they were part of it or beside it; else
// with their own surface; else, if no sample says which one that is, with what is behind.
inline Origin originOf(const ShowPass& pass, const Layout& layout, const Target& target) {
  // A pixel of something else among pixels of the surface is something thin.
  const Lanes zero = lanesOf(0), any = lanesOf(1), most = lanesOf(5);
  const auto moved = [&](Lanes away) { return target.source + hn::ConvertTo(IndicesTag(), away); };
  const Candidate own = candidateOf(pass, layout, target, target.source);
  Origin origin{own.past, own.at, target.source, own.rests, any < zero};
  const Lanes trust = gather(pass.fresh.trust.data(), target.source);
  const Mask seen =
      hn::And(target.exists, hn::Or(hn::Not(target.hit), trust >= lanesOf(Fresh::seen)));

  const Lanes front = gather(pass.fresh.front.data(), target.source);
  const Mask hasFront = hn::And(seen, hn::Not(front == zero));
  if (!hn::AllFalse(LanesTag(), hasFront)) {
    const Candidate candidate = candidateOf(pass, layout, target, moved(front));
    take(origin, candidate, moved(front), wasShown(pass.before, candidate, hasFront, any));
  }
  const Mask anyway =
      hn::And(hn::Or(target.hit, hn::Not(target.some)), trust >= lanesOf(Fresh::seenAround));
  const Mask asked = hn::AndNot(origin.known, seen);
  const Mask accepted = hn::Or(hn::And(asked, hn::And(own.inside, anyway)),
                               wasShown(pass.before, own, hn::AndNot(anyway, asked),
                                        select(hn::Or(target.hit, own.rests), any, most)));
  take(origin, own, target.source, accepted);

  const Lanes behind = gather(pass.fresh.behind.data(), target.source);
  const Mask open =
      hn::AndNot(hn::Or(origin.known, target.hit), hn::And(target.exists, hn::Not(behind == zero)));
  if (!hn::AllFalse(LanesTag(), open)) {
    const Candidate candidate = candidateOf(pass, layout, target, moved(behind));
    take(origin, candidate, moved(behind),
         wasShown(pass.before, candidate, open, select(candidate.rests, any, most)));
  }
  return origin;
}

// Returns where a pixel that rests was covered, or its neighbours were, by something in front that
// has moved away since, or by something that is gone: what was shown there is not its own colour.
inline Mask wasUncovered(const ShowPass& pass, Mask rests, Lanes nearness, size_t i) {
  const Mask none = lanesOf(1) < lanesOf(0);
  if (hn::AllFalse(LanesTag(), rests)) return none;
  const Surfaces& old = pass.before.surfaces;
  const auto stride = ptrdiff_t(pass.before.layout.stride);
  const Lanes scale = pass.pixels.projection.parallel ? lanesOf(1) : nearness;
  const Lanes front = nearness + lanesOf(nearer) * scale;
  Mask covered = none;
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Mask ahead =
          hn::And(load(old.name.data() + j) >= lanesOf(0), load(old.nearness.data() + j) > front);
      const Lanes moves = load(old.moves.data() + j);
      covered =
          hn::Or(covered, hn::Or(hn::And(ahead, moves > lanesOf(0)), moves >= lanesOf(isGone)));
    }
  return hn::And(rests, covered);
}

// The surfaces that pixels show: that of the sample in a pixel, else what it was, else that of the
// frame's pixel around it.
struct Visible {
  Indices source; // in the frame
  Mask stays;     // the old one goes on, which is another one than that which tells the motion
  Lanes name;
};

inline Visible visibleAt(const ShowPass& pass, const Target& target, const Origin& origin) {
  const Indices source =
      hn::IfThenElse(hn::RebindMask(IndicesTag(), hn::Or(target.hit, hn::Not(origin.known))),
                     target.source, origin.source);
  const Lanes name = gather(pass.pixels.guides.name.data(), source),
              old = gather(pass.before.surfaces.name.data(), origin.at);
  const Mask stays = hn::And(hn::AndNot(target.hit, origin.known), hn::Not(old == name));
  return {source, stays, select(stays, old, name)};
}

inline void keepSurfaces(const ShowPass& pass, const Target& target, const Origin& origin,
                         const Visible& visible, Surfaces& surfaces) {
  const Guides& guides = pass.pixels.guides;
  const Surfaces& old = pass.before.surfaces;
  const bool any = !hn::AllFalse(LanesTag(), visible.stays);
  const auto keep = [&](const Plane& now, const Plane& before, Plane& to) {
    Lanes v = gather(now.data(), visible.source);
    if (any) v = select(visible.stays, gather(before.data(), origin.at), v);
    store(v, to.data() + target.i);
  };
  keep(guides.nearness, old.nearness, surfaces.nearness);
  keep(guides.moves, old.moves, surfaces.moves);
  keep(guides.normal.x, old.normal.x, surfaces.normal.x);
  keep(guides.normal.y, old.normal.y, surfaces.normal.y);
  keep(guides.normal.z, old.normal.z, surfaces.normal.z);
  store(select(target.exists, visible.name, lanesOf(outsideName)), surfaces.name.data() + target.i);
}

// Where the centres of pixels lie between those of the frame's.
struct Between {
  Indices corner; // the frame's pixel above and to the left
  Lanes partX, partY;
  int32_t stride;

  Indices at(int k) const { return corner + hn::Set(IndicesTag(), (k / 2) * stride + k % 2); }
  Lanes weight(int k) const {
    const Lanes one = lanesOf(1);
    return (k % 2 ? partX : one - partX) * (k / 2 ? partY : one - partY);
  }
};

inline Between betweenAt(const ShowPass& pass, const Layout& layout, const Target& target) {
  const Layout& frame = pass.pixels.layout;
  const Resampling alongX(layout.width, frame.width), alongY(layout.height, frame.height);
  const Lanes x = countFrom(target.x) * lanesOf(alongX.ratio) + lanesOf(alongX.shift);
  const float y = alongY(float(target.y)), top = std::floor(y);
  // Pixels behind the end of a row are not shown; their places are kept within the planes.
  const Lanes inside = min(x, lanesOf(float(frame.width))), left = hn::Floor(inside);
  const Indices row = hn::Set(IndicesTag(), int32_t(frame.row(int(top))));
  return {row + hn::ConvertTo(IndicesTag(), left), inside - left, lanesOf(y - top),
          int32_t(frame.stride)};
}

// Returns the colours around the centres of pixels, linearly between the centres of the frame's.
inline LaneVec coloursAround(const ShowPass& pass, const Between& between) {
  LaneVec sum = gather(pass.fresh.colour, between.at(0)) * between.weight(0);
  for (int k = 1; k < 4; k++)
    sum = sum + gather(pass.fresh.colour, between.at(k)) * between.weight(k);
  return sum;
}

// Returns the luma of the illumination around pixels, of the shapes that they show; 0: unknown.
inline Lanes levelAround(const ShowPass& pass, const Between& between, Lanes name) {
  Lanes sum = lanesOf(0), weights = lanesOf(0);
  for (int k = 0; k < 4; k++) {
    const Indices at = between.at(k);
    const Lanes weight =
        hn::IfThenElseZero(gather(pass.pixels.guides.name.data(), at) == name, between.weight(k));
    sum = sum + gather(pass.fresh.light.x.data(), at) * weight;
    weights = weights + weight;
  }
  const Mask some = weights > lanesOf(0.01f);
  return hn::IfThenElseZero(some, sum / select(some, weights, lanesOf(1)));
}

// How many samples pixels have now, and the part of their colours that is new.
struct Weights {
  Lanes samples, part;
};

// Returns how many samples a frame has for each pixel.
inline float shareOf(const ShowPass& pass, const Layout& layout) {
  const Layout& frame = pass.pixels.layout;
  return float(double(frame.width) * frame.height / (double(layout.width) * layout.height));
}

inline Weights weightsOf(float share, const Target& target, Lanes old, Lanes mostFrames) {
  const Lanes one = lanesOf(1);
  const Lanes most = max(mostFrames * lanesOf(share), lanesOf(share < 1 ? fewestSamples : 1));
  const Mask lends = hn::AndNot(target.hit, old < one);
  const Lanes added = hn::IfThenElseZero(
      target.some, select(target.hit, one, hn::IfThenElseZero(lends, lanesOf(share))));
  const Lanes samples = min(old + added, most);
  return {samples, hn::IfThenElseZero(added > lanesOf(0), min(added / samples, one))};
}

// The pixels of the frame that those of `target` have the middles of, in planes without a border.
inline Indices pixelsOf(const ShowPass& pass, const Target& target) {
  const IndicesTag tag;
  const int row = pass.rows.middle[size_t(target.y)];
  return hn::Set(tag, row * pass.pixels.layout.width) +
         hn::LoadU(tag, pass.columns.middle.data() + target.x);
}

// Returns where several samples of a pixel may show more than one surface. `low` and `high` receive
// the colours around.
inline Mask mixesSurfaces(const ShowPass& pass, const Target& target, LaneVec& low, LaneVec& high) {
  const Guides& guides = pass.pixels.guides;
  const auto stride = int32_t(pass.pixels.layout.stride);
  const Lanes name = gather(guides.name.data(), target.source);
  const LaneVec normal = gather(guides.normal, target.source);
  low = high = gather(pass.fresh.colour, target.source);
  Mask mixes = name < name;
  for (int k = 0; k < 9; k++) {
    const Indices at = target.source + hn::Set(IndicesTag(), (k / 3 - 1) * stride + k % 3 - 1);
    const Lanes other = gather(guides.name.data(), at);
    const LaneVec colour = gather(pass.fresh.colour, at);
    const Mask otherSide =
        hn::Or(hn::Not(other == name), dot(gather(guides.normal, at), normal) < lanesOf(sameSide));
    mixes = hn::Or(mixes, hn::And(other >= lanesOf(0), otherSide));
    low = {min(low.x, colour.x), min(low.y, colour.y), min(low.z, colour.z)};
    high = {max(high.x, colour.x), max(high.y, colour.y), max(high.z, colour.z)};
  }
  return hn::And(mixes, target.some);
}

// The colours of a frame, how noisy their light is, and how many frames are accumulated in motion.
struct New {
  LaneVec fresh;
  Lanes noisy, frames;
};

// Several samples smooth the edges and textures of a pixel in one frame already, but not the light.
// At edges they show several surfaces, and the filter has only followed one: the samples themselves
// count there, within the colours around.
inline New severalSamples(const ShowPass& pass, const Target& target, const New& one) {
  const Lanes least = lanesOf(std::max(1.0f, framesMoving / pass.perPixel)), zero = lanesOf(0);
  LaneVec low, high;
  const Mask mixes = mixesSurfaces(pass, target, low, high);
  const Indices first = hn::ShiftLeft<2>(pixelsOf(pass, target));
  const auto sampled = [&](int colour, Lanes least, Lanes most) {
    const Lanes v = gather(pass.frame.rgba + colour, first);
    return clamp(select(isFinite(v), v, zero), least, most);
  };
  const LaneVec samples{sampled(0, low.x, high.x), sampled(1, low.y, high.y),
                        sampled(2, low.z, high.z)};
  return {select(mixes, samples, one.fresh), one.noisy, least + (one.frames - least) * one.noisy};
}

// Returns by how much light has to change to have another level, as far as it is noisy: shadows
// without noise are as sharp as the pixels, and levels are not.
inline Lanes changeOf(Lanes from, Lanes to, Lanes noisy) {
  const Lanes one = lanesOf(1), zero = lanesOf(0);
  const Mask known = hn::And(from > zero, to > zero);
  const Lanes ratio = clamp(to / select(known, from, one), lanesOf(0.5f), lanesOf(2));
  return select(known, one + (ratio - one) * noisy, one);
}

inline Lanes mixed(Lanes old, Lanes fresh, Lanes low, Lanes high, Lanes part) {
  const Lanes kept = clamp(old, low, high);
  return max(select(part < lanesOf(1), kept + (fresh - kept) * part, fresh), lanesOf(0));
}

// Writes the colours of pixels with the alpha of the frame.
inline void writeColours(const ShowPass& pass, const Layout& layout, const Target& target,
                         const LaneVec& colour, float* rgba) {
  const Indices pixel = pixelsOf(pass, target);
  // Pixels without light of their own have no alpha of their own.
  const Mask lit = gather(pass.frame.samples, pixel) > lanesOf(0);
  const Lanes alpha = gather(pass.frame.rgba + 3, hn::ShiftLeft<2>(pixel));
  float out[4 * Layout::widest];
  hn::StoreInterleaved4(
      colour.x, colour.y, colour.z,
      select(hn::And(lit, isFinite(alpha)), clamp(alpha, lanesOf(0), lanesOf(1)), lanesOf(1)),
      LanesTag(), out);
  std::copy_n(out, 4 * std::min(width(), layout.width - target.x), rgba + 4 * target.x);
}

void showRow(const ShowPass& pass, int y, Shown& shown, float* rgba) {
  const Layout &layout = shown.layout, &old = pass.before.layout;
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const float share = shareOf(pass, layout);
  const bool areSeveral = pass.perPixel > 1 && layout == pass.pixels.layout;
  for (int x = 0; x < layout.width; x += width()) {
    const Target target = targetAt(pass, layout, x, y);
    Origin origin = originOf(pass, layout, target);
    const Mask rests = hn::And(origin.known, origin.rests);
    const Lanes nearness = gather(pass.pixels.guides.nearness.data(), origin.source);
    origin.known = hn::AndNot(wasUncovered(pass, rests, nearness, target.i), origin.known);

    Lanes samples;
    LaneVec before = shownNumbers(old, pass.before.colour, {origin.past, origin.known}, samples);
    samples = samples * gather(pass.bounds.valid.data(), target.source);
    const Lanes noise = gather(pass.fresh.noise.data(), target.source);
    const Mask quiet = hn::And(rests, noise <= zero);
    New now{gather(pass.fresh.colour, target.source), min(noise + noise, one),
            lanesOf(framesMoving)};
    if (areSeveral) now = severalSamples(pass, target, now);
    const Lanes most =
        select(quiet, lanesOf(framesAtRest), select(rests, lanesOf(framesSampled), now.frames));
    const Weights weights = weightsOf(share, target, samples, most);
    const Between between = betweenAt(pass, layout, target);
    LaneVec fresh = now.fresh;
    const Mask lent = hn::And(target.exists, hn::AndNot(target.hit, samples < one));
    if (!hn::AllFalse(LanesTag(), lent))
      fresh = select(target.hit, fresh, coloursAround(pass, between));

    // A pixel has a sample of its own now and then; the light on it changes with each frame.
    const Visible visible = visibleAt(pass, target, origin);
    const Lanes around = levelAround(pass, between, visible.name),
                level =
                    hn::IfThenElseZero(origin.known, gather(pass.before.level.data(), origin.at));
    const Lanes frames = min(samples * lanesOf(1 / share) + one, most);
    const Mask known = hn::And(level > zero, around > zero);
    const Lanes brightness = select(known, level + (around - level) / max(frames, one),
                                    select(around > zero, around, level));
    before = before * changeOf(level, brightness, now.noisy);
    const Lanes own = gather(pass.fresh.light.x.data(), target.source);
    fresh = fresh * changeOf(select(target.hit, own, around), brightness, now.noisy);
    store(brightness, shown.level.data() + target.i);
    const LaneVec low = gather(pass.bounds.low, target.source),
                  high = gather(pass.bounds.high, target.source);
    const LaneVec accumulated{mixed(before.x, fresh.x, low.x, high.x, weights.part),
                              mixed(before.y, fresh.y, low.y, high.y, weights.part),
                              mixed(before.z, fresh.z, low.z, high.z, weights.part)};
    const LaneVec kept{max(before.x, zero), max(before.y, zero), max(before.z, zero)};
    const LaneVec colour = select(target.some, accumulated, kept);
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(target.some, weights.samples, min(samples, one)), LanesTag(),
                          shown.colour.data() + 4 * target.i);
    keepSurfaces(pass, target, origin, visible, shown.surfaces);
    writeColours(pass, layout, target, colour, rgba);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {

Overlaps::Overlaps(int framePixels, int picturePixels)
    : frame(framePixels), picture(picturePixels) {
  const size_t size = size_t(picture) + Layout::widest;
  for (std::vector<int32_t>* one : {&first, &last, &middle}) one->assign(size, 0);
  for (int at = 0; at < picture; at++) {
    const int64_t n = frame, of = picture, p = at;
    first[size_t(at)] = int32_t(p * n / of);
    last[size_t(at)] = int32_t(((p + 1) * n + of - 1) / of - 1);
    middle[size_t(at)] = int32_t((2 * p + 1) * n / (2 * of));
  }
}

HWY_EXPORT(showRow);
void showRow(const ShowPass& pass, int y, Shown& shown, float* rgba) {
  HWY_DYNAMIC_DISPATCH(showRow)(pass, y, shown, rgba);
}
} // namespace picture::live
#endif
