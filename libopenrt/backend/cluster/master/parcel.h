// parcel.h: commits made ready to travel: the edits as bytes, the arrays by what is in them, the
// shader libraries by name and hash. Made once, sent to many. Arrays are packed once, when a worker
// turns out to need them. One thread's, but for Offer::pack.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "backend/cluster/net/libraries.h"
#include "backend/cluster/net/messages.h"
#include "scene/commit.h"

namespace openrt {
class ShaderRegistry;
}

namespace openrt::cluster {

// An array that workers may need. It lives as long as one of them may, or gets it.
struct Offer {
  ArrayPtr array;
  Hash hash;
  std::vector<std::byte> packed;     // after pack()
  bool asked = false, ready = false; // to be packed; it is
  void pack();                       // [any], once
};
using OfferPtr = std::shared_ptr<Offer>;

struct Parcel {
  std::shared_ptr<const Commit> commit;
  std::vector<message::ArrayName> arrays; // by their numbers
  std::vector<OfferPtr> offers;           // each array once
  std::vector<message::Library> libraries;
  std::vector<std::byte> edits;
  size_t bytes = 0; // about, of edits and arrays
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
  std::unordered_map<const Array*, std::pair<std::weak_ptr<const Array>, Hash>>
      hashes_; // of arrays that were seen
  size_t sweepAt_ = 64;
  FileHashes files_; // of shader libraries
};

} // namespace openrt::cluster
