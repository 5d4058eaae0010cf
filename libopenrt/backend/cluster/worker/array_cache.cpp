#include "backend/cluster/worker/array_cache.h"

#include <xxhash.h>
#include <zstd.h>

namespace openrt::cluster {

ArrayPtr ArrayCache::find(const Hash& hash, uint64_t bytes) {
  const auto found = entries_.find(hash);
  if (found == entries_.end() || found->second.array->size() != bytes) return nullptr;
  ages_.splice(ages_.end(), ages_, found->second.age);
  return found->second.array;
}

void ArrayCache::put(const Hash& hash, ArrayPtr array) {
  const auto [place, fresh] = entries_.try_emplace(hash);
  if (!fresh) return;
  bytes_ += array->size();
  place->second = {std::move(array), ages_.insert(ages_.end(), hash)};
}

void ArrayCache::trim() {
  for (auto age = ages_.begin(); bytes_ > limit_ && age != ages_.end();) {
    const auto entry = entries_.find(*age);
    if (entry->second.array.use_count() > 1) { // used by the scene or by one that waits for arrays
      ++age;
      continue;
    }
    bytes_ -= entry->second.array->size();
    entries_.erase(entry);
    age = ages_.erase(age);
  }
}

struct ArrayStream::Impl {
  struct Free {
    void operator()(ZSTD_DStream* s) const { ZSTD_freeDStream(s); }
    void operator()(XXH3_state_t* s) const { XXH3_freeState(s); }
  };
  Hash hash;
  // Null before the first piece, which tells the packed size.
  std::shared_ptr<Array> array;
  uint64_t bytes = 0, written = 0, stored = 0, received = 0;
  // About 100 kB, so it is made only for arrays that are really sent.
  std::unique_ptr<ZSTD_DStream, Free> zstd;
  std::unique_ptr<XXH3_state_t, Free> state;
  bool ended = false;
  ArrayFolder* folder = nullptr;
  std::optional<ArrayFolder::Writer> writer;

  void begin(uint64_t allStored) {
    array = std::make_shared<Array>(bytes);
    zstd.reset(ZSTD_createDStream());
    state.reset(XXH3_createState());
    if (!zstd || !state) throw std::bad_alloc();
    XXH3_128bits_reset(state.get());
    stored = allStored;
    if (folder && bytes >= limits::keptArrayBytes) writer.emplace(*folder, hash, stored);
  }
};

ArrayStream::ArrayStream(const Hash& hash, uint64_t bytes, ArrayFolder* folder)
    : impl_(std::make_unique<Impl>()) {
  impl_->hash = hash;
  impl_->bytes = bytes;
  impl_->folder = folder;
}
ArrayStream::~ArrayStream() = default;
ArrayStream::ArrayStream(ArrayStream&&) noexcept = default;

std::string ArrayStream::put(const message::Piece& piece) {
  Impl& s = *impl_;
  if (piece.bytes != s.bytes) return "a piece is of an array of another size";
  if (s.stored == 0) s.begin(piece.stored);
  if (piece.stored != s.stored || piece.offset != s.received) return "a piece is out of order";
  s.received += piece.data.size();
  ZSTD_inBuffer in{piece.data.data(), piece.data.size(), 0};
  ZSTD_outBuffer out{s.array->data(), s.bytes, s.written};
  while (in.pos < in.size && !s.ended) {
    const size_t before = in.pos, filled = out.pos;
    const size_t rest = ZSTD_decompressStream(s.zstd.get(), &out, &in);
    if (ZSTD_isError(rest)) return std::string("zstd: ") + ZSTD_getErrorName(rest);
    s.ended = rest == 0;
    if (in.pos == before && out.pos == filled) break; // the data exceeds the array
  }
  XXH3_128bits_update(s.state.get(), s.array->data() + s.written, out.pos - s.written);
  s.written = out.pos;
  if (in.pos < in.size) return "an array is larger than it should be";
  if (s.writer) s.writer->write(piece.data);
  return {};
}

uint64_t ArrayStream::bytes() const { return impl_->bytes; }
bool ArrayStream::begun() const { return impl_->stored != 0; }
bool ArrayStream::complete() const {
  return impl_->stored != 0 && impl_->received == impl_->stored;
}

ArrayPtr ArrayStream::take() {
  Impl& s = *impl_;
  const XXH128_hash_t found = XXH3_128bits_digest(s.state.get());
  if (!s.ended || s.written != s.bytes || Hash{found.low64, found.high64} != s.hash) return nullptr;
  if (s.writer) s.writer->keep();
  return std::move(s.array);
}

} // namespace openrt::cluster
