// parcel.h: commits in the form in which they are sent: the edits as bytes, the arrays by content
// hash, the shader libraries by name and hash. A commit is packed once and sent to many workers. An
// array is compressed once, when the first worker needs it. One thread, except Offer::pack.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/libraries.h"
#include "scene/commit.h"

namespace openrt {
class ShaderRegistry;
}

namespace openrt::cluster {

// An array that workers may need. It lives as long as a worker may need it or is receiving it.
struct Offer {
  ArrayPtr array;
  Hash hash;
  std::vector<std::byte> packed;             // compressed content, filled by pack()
  bool packRequested = false, ready = false; // packing was requested; it is done
  void pack();                               // [any], called once
};
using OfferPtr = std::shared_ptr<Offer>;

struct Parcel {
  std::shared_ptr<const Commit> commit;
  std::vector<message::ArrayName> arrays; // sorted by array number
  std::vector<OfferPtr> offers;           // one per distinct content
  std::vector<message::Library> libraries;
  std::vector<std::byte> edits;
  size_t bytes = 0; // approximate size of edits and arrays
};
using ParcelPtr = std::shared_ptr<const Parcel>;

class Packer {
 public:
  explicit Packer(const ShaderRegistry* shaders) : shaders_(shaders) {}
  ParcelPtr pack(std::shared_ptr<const Commit> commit);

 private:
  OfferPtr offer(const ArrayPtr& array);
  void addLibraries(const Commit& commit, Parcel& parcel);

  const ShaderRegistry* shaders_;
  std::map<Hash, std::weak_ptr<Offer>> offers_;
  // Hashes of arrays seen before.
  std::unordered_map<const Array*, std::pair<std::weak_ptr<const Array>, Hash>> hashes_;
  size_t sweepAt_ = 64;
  FileHashes files_; // hashes of the shader library files
};

} // namespace openrt::cluster
