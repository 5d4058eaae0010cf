// sums_codec.cpp: kept sums as bytes. Little-endian, not aligned:
//   8 bytes "ORTSUMS1"; 8 bytes: XXH3 of all that follows
//   3 texts (version, instruction set, kernel): 4 bytes for the length, the characters
//   digests of the world and of the view, 8 bytes each
//   the settings of the frame: 4 bytes for the length, a flatbuffer (edits.fbs, FrameSettings)
//   a byte of flags: 1 camera, 2 lamps, 4 complete, 8 condensed; 8 bytes: FrameFacts::guide
//   4 bytes: the number of blocks of seeds; then each:
//     first seed, count; light: number of parts, of values, the values; rays
//     the number of tiles; for each the number of blocks; for each seed and shift of the
//     replicates, first sample, count, rays, length, bytes of the result (result_codec.h)
// Whatever is read may come from anywhere. No count is believed before as many bytes are there.
#include "render/frame/frame_sums.h"

#include <bit>
#include <cstring>

#include <xxhash.h>

#include "picture_size.h"
#include "render/film/error.h"
#include "render/frame/result_codec.h"
#include "scene/channels.h"
#include "scene/quality.h"

namespace openrt {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr char magic[8] = {'O', 'R', 'T', 'S', 'U', 'M', 'S', '1'};
constexpr uint8_t hasCamera = 1, hasLamps = 2, isComplete = 4, isCondensed = 8;
constexpr uint32_t mostSamples = 65536;
constexpr uint32_t mostBlocks = 2 * mostSamples / fewestOfLeaves; // blocks of a tile and its pilots
// Seeds of merged sums: their samples are counted in 32 bits.
constexpr uint64_t mostSamplesOfAll = 0xffffffffu;

class Writer {
 public:
  std::vector<std::byte> out;
  void bytes(const void* from, size_t size) {
    const size_t at = out.size();
    out.resize(at + size);
    if (size) std::memcpy(out.data() + at, from, size);
  }
  template <class T> void number(T value) { bytes(&value, sizeof value); }
  void text(const std::string& value) {
    number(uint32_t(value.size()));
    bytes(value.data(), value.size());
  }
  void rays(const RayTotals& r) {
    for (const uint64_t n : {r.camera, r.shadow, r.secondary, r.faults}) number(n);
  }
};

[[noreturn]] void damaged(const char* why) {
  throw SumsError(std::string("it is damaged: ") + why);
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
  std::span<const std::byte> bytes(uint64_t size) {
    if (size > left_.size()) damaged("it ends too early");
    const auto taken = left_.first(size_t(size));
    left_ = left_.subspan(size_t(size));
    return taken;
  }
  template <class T> T number() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto all = bytes(number<uint32_t>());
    return {reinterpret_cast<const char*>(all.data()), all.size()};
  }
  RayTotals rays() {
    RayTotals r;
    for (uint64_t* n : {&r.camera, &r.shadow, &r.secondary, &r.faults}) *n = number<uint64_t>();
    return r;
  }
  size_t left() const { return left_.size(); }

 private:
  std::span<const std::byte> left_;
};

void writeSeeds(Writer& w, const SeedSums& seeds) {
  w.number(seeds.first);
  w.number(seeds.count);
  w.number(seeds.light.added);
  w.number(uint64_t(seeds.light.values.size()));
  w.bytes(seeds.light.values.data(), seeds.light.values.size() * sizeof(double));
  w.rays(seeds.lightRays);
  w.number(uint32_t(seeds.tiles.size()));
  for (const std::vector<KeptBlock>& blocks : seeds.tiles) {
    w.number(uint32_t(blocks.size()));
    for (const KeptBlock& b : blocks) {
      for (const uint32_t n : {b.replicates.seed, b.replicates.shift, b.first, b.count})
        w.number(n);
      w.rays(b.rays);
      w.number(uint64_t(b.bytes->size()));
      w.bytes(b.bytes->data(), b.bytes->size());
    }
  }
}

edit::FrameSettingsT readFrame(Reader& r) {
  const auto bytes = r.bytes(r.number<uint32_t>());
  const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
  // The bytes are copied, because a flatbuffer must be aligned.
  const std::vector<uint8_t> aligned(data, data + bytes.size());
  flatbuffers::Verifier verifier(aligned.data(), aligned.size());
  if (!verifier.VerifyBuffer<edit::FrameSettings>(nullptr)) damaged("its settings are unreadable");
  edit::FrameSettingsT frame;
  flatbuffers::GetRoot<edit::FrameSettings>(aligned.data())->UnPackTo(&frame);
  const bool fits = isPictureSize(frame.width, frame.height) && frame.channels != 0 &&
                    (frame.channels & ~allChannels) == 0 && !invalidQuality(frame) &&
                    frame.timeLimit == 0 && frame.scissorX < largestSide &&
                    frame.scissorY < largestSide && frame.scissorWidth <= largestSide &&
                    frame.scissorHeight <= largestSide &&
                    (frame.scissorWidth == 0) == (frame.scissorHeight == 0);
  if (!fits) damaged("its settings are not those of a picture");
  return frame;
}

// Whether the blocks of a tile may be used: they must not overlap, and must be readable.
void checkTile(const FrameSums& sums, const Tile& tile, std::span<const KeptBlock> blocks) {
  JobResult room;
  for (size_t i = 0; i < blocks.size(); i++) {
    const KeptBlock& b = blocks[i];
    const uint32_t most = std::max(sums.frame.samples, fewestOfLeaves);
    if (b.count == 0 || b.first >= most || b.count > most - b.first || b.replicates.shift > 31)
      damaged("it has samples that its picture does not have");
    for (size_t k = 0; k < i; k++)
      if (blocks[k].replicates == b.replicates && blocks[k].first < b.first + b.count &&
          b.first < blocks[k].first + blocks[k].count)
        damaged("it has samples twice");
    if (!decodeResult(sums.frame, jobOf(0, b), tile, *b.bytes, room))
      damaged("it has sums of another size");
  }
  if (!sums.condensed) return;
  const Replicates wanted =
      replicatesOf(sums.frame, sums.frame.samples, blocks.empty() ? 0 : blocks[0].replicates.seed);
  if (blocks.size() != 1 || blocks[0].first != 0 || blocks[0].count != sums.frame.samples ||
      !(blocks[0].replicates == wanted))
    damaged("it lacks samples of its picture");
}

SeedSums readSeeds(Reader& r, const FrameSums& sums) {
  constexpr size_t leastOfBlock = 4 * 4 + 4 * 8 + 8;
  SeedSums seeds;
  const TileGrid grid(sums.frame);
  const uint32_t tiles = sums.facts.camera ? grid.count() : 0;
  seeds.first = r.number<uint32_t>();
  seeds.count = r.number<uint32_t>();
  if (seeds.count == 0 || seeds.count > ~0u - seeds.first ||
      uint64_t(seeds.count) * sums.frame.samples > mostSamplesOfAll)
    damaged("its seeds are out of range");
  seeds.light.added = r.number<uint32_t>();
  const auto values = r.number<uint64_t>();
  if (values > r.left() / sizeof(double)) damaged("it ends too early");
  const size_t pixels = size_t(sums.frame.width) * sums.frame.height;
  const uint32_t parts = LightImage::partsOf(sums.frame);
  const bool errors =
      wantsError(sums.frame) || (sums.frame.samples > 1 && (sums.frame.channels & RT_VARIANCE));
  const bool lamps = sums.facts.lamps && tiles > 0;
  if (values != (lamps ? pixels * (errors ? 6 : 3) : 0) ||
      (sums.condensed ? seeds.light.added != (lamps ? uint64_t(parts) * seeds.count : 0)
                      : seeds.light.added > (lamps ? parts : 0)))
    damaged("its light paths are not those of its picture");
  seeds.light.values.resize(size_t(values));
  const auto light = r.bytes(values * sizeof(double));
  if (!light.empty()) std::memcpy(seeds.light.values.data(), light.data(), light.size());
  seeds.lightRays = r.rays();
  if (r.number<uint32_t>() != tiles) damaged("it has another number of tiles");
  if (tiles > r.left() / sizeof(uint32_t)) damaged("it ends too early");
  seeds.tiles.resize(tiles);
  for (uint32_t i = 0; i < tiles; i++) {
    const auto count = r.number<uint32_t>();
    if (count > r.left() / leastOfBlock) damaged("it ends too early");
    if (count > mostBlocks) damaged("it has more blocks of samples than a picture");
    for (uint32_t k = 0; k < count; k++) {
      KeptBlock b;
      for (uint32_t* n : {&b.replicates.seed, &b.replicates.shift, &b.first, &b.count})
        *n = r.number<uint32_t>();
      b.rays = r.rays();
      const auto bytes = r.bytes(r.number<uint64_t>());
      b.bytes = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
      seeds.tiles[i].push_back(std::move(b));
    }
    checkTile(sums, grid.at(i), seeds.tiles[i]);
  }
  return seeds;
}

} // namespace

std::vector<std::byte> writeSums(const FrameSums& sums) {
  Writer w;
  w.bytes(magic, sizeof magic);
  w.number(uint64_t(0));
  for (const std::string* text :
       {&sums.identity.version, &sums.identity.isa, &sums.identity.kernel})
    w.text(*text);
  w.number(sums.identity.world);
  w.number(sums.identity.view);
  edit::FrameSettingsT frame = sums.frame;
  frame.progressive = false; // it does not change sums
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(edit::FrameSettings::Pack(builder, &frame));
  w.number(uint32_t(builder.GetSize()));
  w.bytes(builder.GetBufferPointer(), builder.GetSize());
  w.number(uint8_t((sums.facts.camera ? hasCamera : 0) | (sums.facts.lamps ? hasLamps : 0) |
                   (sums.complete ? isComplete : 0) | (sums.condensed ? isCondensed : 0)));
  w.number(sums.facts.guide);
  w.number(uint32_t(sums.seeds.size()));
  for (const SeedSums& seeds : sums.seeds) writeSeeds(w, seeds);
  constexpr size_t head = sizeof magic + sizeof(uint64_t);
  const uint64_t check = XXH3_64bits(w.out.data() + head, w.out.size() - head);
  std::memcpy(w.out.data() + sizeof magic, &check, sizeof check);
  return std::move(w.out);
}

FrameSumsPtr readSums(std::span<const std::byte> bytes) {
  Reader r(bytes);
  if (bytes.size() < sizeof magic || std::memcmp(bytes.data(), magic, sizeof magic - 1) != 0)
    throw SumsError("it holds no sums");
  if (bytes[sizeof magic - 1] != std::byte(magic[sizeof magic - 1]))
    throw SumsError("it was made by another version");
  r.bytes(sizeof magic);
  const auto check = r.number<uint64_t>();
  const auto rest = bytes.subspan(bytes.size() - r.left());
  if (XXH3_64bits(rest.data(), rest.size()) != check)
    damaged("its checksum differs, or it is not complete");
  auto sums = std::make_shared<FrameSums>();
  for (std::string* text : {&sums->identity.version, &sums->identity.isa, &sums->identity.kernel})
    *text = r.text();
  sums->identity.world = r.number<uint64_t>();
  sums->identity.view = r.number<uint64_t>();
  sums->frame = readFrame(r);
  const auto flags = r.number<uint8_t>();
  sums->facts = {(flags & hasCamera) != 0, (flags & hasLamps) != 0, r.number<uint64_t>()};
  sums->complete = flags & isComplete;
  sums->condensed = flags & isCondensed;
  const auto count = r.number<uint32_t>();
  if (count == 0 || (!sums->condensed && count != 1)) damaged("it has no seed");
  uint64_t next = 0, seeds = 0;
  for (uint32_t i = 0; i < count; i++) {
    sums->seeds.push_back(readSeeds(r, *sums));
    const SeedSums& last = sums->seeds.back();
    if (last.first < next) damaged("it has a seed twice");
    next = uint64_t(last.first) + last.count;
    seeds += last.count;
  }
  if (seeds * sums->frame.samples > mostSamplesOfAll) damaged("its seeds are out of range");
  if (r.left() > 0) damaged("more follows than was expected");
  sums->frame.seed = sums->seeds[0].first;
  return sums;
}

} // namespace openrt
