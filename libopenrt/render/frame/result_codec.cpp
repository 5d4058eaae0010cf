#include "render/frame/result_codec.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "openrt/openrt.h"
#include "render/wave/random_numbers.h"

namespace openrt {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Form : uint8_t { one, floats, all };

struct Field { // a field of PixelSums
  size_t offset, bytes, count;
};
#define FIELD(name)                                                                                \
  Field {                                                                                          \
    offsetof(PixelSums, name), sizeof(*elements(&PixelSums::name)), countOf(&PixelSums::name)      \
  }
template <class T, size_t n> T* elements(T (PixelSums::*)[n]);
template <class T> T* elements(T PixelSums::*);
template <class T, size_t n> constexpr size_t countOf(T (PixelSums::*)[n]) { return n; }
template <class T> constexpr size_t countOf(T PixelSums::*) { return 1; }

std::vector<Field> fieldsOf(const edit::FrameSettingsT& frame) {
  const RequiredSums required = requiredSums(frame);
  std::vector<Field> fields{FIELD(rgba)};
  const auto addChannels = [&](ChannelSource source, const Field& all) {
    for (const ChannelInfo& row : channelTable)
      if (row.source == source && (frame.channels & row.bit))
        fields.push_back({all.offset + row.place * all.bytes, all.bytes, row.components});
  };
  addChannels(ChannelSource::firstSample, FIELD(firstValues));
  if (required.spread) fields.insert(fields.end(), {FIELD(first), FIELD(delta), FIELD(delta2)});
  addChannels(ChannelSource::mean, FIELD(valueSums));
  if (required.error)
    fields.insert(fields.end(), {FIELD(closed), FIELD(closed2), FIELD(closed3), FIELD(closed4),
                                 FIELD(grey), FIELD(largest), FIELD(random)});
  return fields;
}
#undef FIELD

void put(std::vector<std::byte>& out, const void* from, size_t bytes) {
  const size_t at = out.size();
  out.resize(at + bytes);
  if (bytes > 0) std::memcpy(out.data() + at, from, bytes); // `from` may be null
}

// Returns whether the conversion to float is lossless. Denormal floats are refused, because some
// threads flush them to zero.
bool fits(double x, float& f) {
  f = static_cast<float>(x);
  const uint32_t bits = std::bit_cast<uint32_t>(f);
  if ((bits & 0x7f800000u) == 0 && (bits & 0x7fffffu) != 0) return false;
  return std::bit_cast<uint64_t>(double(f)) == std::bit_cast<uint64_t>(x);
}

void putField(std::vector<std::byte>& out, const std::vector<PixelSums>& sums, size_t offset,
              size_t bytes) {
  const auto at = [&](size_t i) { return reinterpret_cast<const std::byte*>(&sums[i]) + offset; };
  bool same = true, floats = bytes == sizeof(double);
  for (size_t i = 0; i < sums.size() && (same || floats); i++) {
    same = same && std::memcmp(at(i), at(0), bytes) == 0;
    if (!floats) continue;
    double x;
    float f;
    std::memcpy(&x, at(i), sizeof x);
    floats = fits(x, f);
  }
  const Form form = same ? Form::one : floats ? Form::floats : Form::all;
  out.push_back(std::byte(form));
  if (form == Form::one) return put(out, at(0), bytes);
  for (size_t i = 0; i < sums.size(); i++) {
    if (form == Form::all) {
      put(out, at(i), bytes);
      continue;
    }
    double x;
    std::memcpy(&x, at(i), sizeof x);
    const auto f = static_cast<float>(x);
    put(out, &f, sizeof f);
  }
}

class Source {
 public:
  explicit Source(std::span<const std::byte> bytes) : left_(bytes) {}
  bool get(void* to, size_t bytes) {
    const std::byte* from = skip(bytes);
    if (from) std::memcpy(to, from, bytes);
    return from;
  }
  // Skips bytes and returns them; null if there are fewer.
  const std::byte* skip(size_t bytes) {
    if (bytes > left_.size()) return nullptr;
    const std::byte* at = left_.data();
    left_ = left_.subspan(bytes);
    return at;
  }
  bool empty() const { return left_.empty(); }

 private:
  std::span<const std::byte> left_;
};

bool getLedger(Source& source, Ledger& ledger) {
  double v[11];
  if (!source.get(v, sizeof v)) return false;
  ledger.cutByDepth = v[0];
  ledger.cutByEnergy = v[1];
  ledger.clipped = v[2];
  ledger.unsampled = {v[3], v[4], v[5], v[6]};
  ledger.unsampledSky = {v[7], v[8], v[9], v[10]};
  return true;
}

// Reads a field; only validates it if `sums` is null. largest: of a field of one byte.
bool getField(Source& source, std::vector<PixelSums>* sums, size_t pixels, size_t offset,
              size_t bytes, uint8_t largest) {
  uint8_t form = 0;
  if (!source.get(&form, 1) || form > uint8_t(Form::all) ||
      (Form(form) == Form::floats && bytes != sizeof(double)))
    return false;
  const size_t each = Form(form) == Form::floats ? sizeof(float) : bytes,
               count = Form(form) == Form::one ? 1 : pixels;
  const std::byte* from = source.skip(each * count);
  if (!from) return false;
  for (size_t i = 0; bytes == 1 && i < count; i++)
    if (from[i] > std::byte(largest)) return false;
  for (size_t i = 0; sums && i < pixels; i++) {
    const std::byte* value = from + (count == 1 ? 0 : i * each);
    std::byte* to = reinterpret_cast<std::byte*>(&(*sums)[i]) + offset;
    if (each == bytes) {
      std::memcpy(to, value, bytes);
      continue;
    }
    float f;
    std::memcpy(&f, value, sizeof f);
    const double x = f;
    std::memcpy(to, &x, sizeof x);
  }
  return true;
}

// Reads the sums of a tile, and sets `source` to what follows; only validates them if `sums` is
// null.
bool getTile(const edit::FrameSettingsT& frame, Source& source, std::vector<PixelSums>* sums,
             size_t pixels) {
  for (const Field& field : fieldsOf(frame))
    for (size_t k = 0; k < field.count; k++)
      if (!getField(source, sums, pixels, field.offset + k * field.bytes, field.bytes,
                    RandomPath::all))
        return false;
  return true;
}

void putHits(std::vector<std::byte>& out, const HitCounts& hits) {
  const auto count = uint32_t(hits.all().size());
  put(out, &count, sizeof count);
  put(out, hits.all().data(), hits.all().size_bytes());
}

bool getHits(Source& source, size_t pixels, HitCounts& hits) {
  uint32_t count = 0;
  if (!source.get(&count, sizeof count)) return false;
  const std::byte* const from = source.skip(size_t(count) * sizeof(HitCount));
  if (!from) return false;
  std::vector<HitCount> counts(count);
  if (count > 0) std::memcpy(counts.data(), from, count * sizeof(HitCount));
  return hits.assign(std::move(counts), uint32_t(pixels));
}

bool zero(float f) { return std::bit_cast<uint32_t>(f) == 0; }

void putLight(std::vector<std::byte>& out, const std::vector<float>& light) {
  constexpr size_t fewest = 4; // shortest run of zeros that is encoded
  for (size_t i = 0; i < light.size();) {
    size_t begin = i;
    while (begin < light.size() && zero(light[begin])) begin++;
    if (begin == light.size()) return;
    size_t end = begin, zeros = 0;
    for (; end < light.size() && zeros < fewest; end++) zeros = zero(light[end]) ? zeros + 1 : 0;
    end -= zeros;
    const uint32_t run[2] = {uint32_t(begin - i), uint32_t(end - begin)};
    put(out, run, sizeof run);
    put(out, &light[begin], (end - begin) * sizeof(float));
    i = end;
  }
}

// Reads light; only validates it if `light` is null.
bool getLight(Source source, size_t size, float* light) {
  for (size_t at = 0; !source.empty();) {
    uint32_t run[2];
    if (!source.get(run, sizeof run) || run[1] == 0 || run[0] > size - at ||
        run[1] > size - at - run[0])
      return false;
    const std::byte* from = source.skip(run[1] * sizeof(float));
    if (!from) return false;
    at += run[0];
    if (light) std::memcpy(light + at, from, run[1] * sizeof(float));
    at += run[1];
  }
  return true;
}

} // namespace

std::vector<std::byte> encodeResult(const edit::FrameSettingsT& frame, const Job& job,
                                    const JobResult& result) {
  std::vector<std::byte> out;
  const Ledger& l = result.ledger;
  const double ledger[11] = {l.cutByDepth,
                             l.cutByEnergy,
                             l.clipped,
                             l.unsampled.light,
                             l.unsampled.rays,
                             l.unsampled.met,
                             l.unsampled.byLightPath,
                             l.unsampledSky.light,
                             l.unsampledSky.rays,
                             l.unsampledSky.met,
                             l.unsampledSky.byLightPath};
  put(out, ledger, sizeof ledger);
  if (job.kind == Job::Kind::light) {
    putLight(out, result.light);
    return out;
  }
  for (const Field& field : fieldsOf(frame))
    for (size_t k = 0; k < field.count; k++)
      putField(out, result.sums, field.offset + k * field.bytes, field.bytes);
  if (requiredSums(frame).names) putHits(out, result.hits);
  return out;
}

bool decodeResult(const edit::FrameSettingsT& frame, const Job& job, const Tile& tile,
                  std::span<const std::byte> bytes, JobResult& result) {
  Source source(bytes);
  result.ledger = {};
  if (!getLedger(source, result.ledger)) return false;
  if (job.kind == Job::Kind::light) {
    const size_t size = size_t(frame.width) * frame.height * 3;
    if (!getLight(source, size, nullptr)) return false;
    result.sums.clear();
    result.light.assign(size, 0.0f);
    return getLight(source, size, result.light.data());
  }
  const size_t pixels = tile.pixels();
  // Validates before memory is allocated.
  Source rest = source;
  result.hits.clear();
  if (!getTile(frame, rest, nullptr, pixels) ||
      (requiredSums(frame).names && !getHits(rest, pixels, result.hits)) || !rest.empty())
    return false;
  result.ledger.samples = job.count;
  result.light.clear();
  result.sums.assign(pixels, {});
  const Replicates& parts = job.replicates;
  const bool closed = requiredSums(frame).error && parts.many() && job.count >= parts.size();
  for (PixelSums& s : result.sums) {
    s.samples = job.count;
    s.replicates = closed ? job.count / parts.size() : 0;
  }
  return getTile(frame, source, &result.sums, pixels);
}

} // namespace openrt
