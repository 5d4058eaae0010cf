#include "backend/cluster/master/parcel.h"

#include <algorithm>

#include "backend/record/edits_bytes.h"
#include "shading/registry.h"

namespace openrt::cluster {

void Offer::pack() { packed = packArray({array->data(), array->size()}); }

OfferPtr Packer::offer(const ArrayPtr& array) {
  auto& [owner, hash] = hashes_[array.get()];
  if (owner.expired()) { // not seen before, or a new array at the same address
    hash = hashOf({array->data(), array->size()});
    owner = array;
  }
  std::weak_ptr<Offer>& known = offers_[hash];
  OfferPtr offer = known.lock();
  if (!offer) {
    offer = std::make_shared<Offer>();
    offer->array = array;
    offer->hash = hash;
    known = offer;
  }
  return offer;
}

// Adds the libraries of the shader classes that the commit names for the first time. A class whose
// library is unknown here is skipped; the worker looks for it itself.
void Packer::addLibraries(const Commit& commit, Parcel& parcel) {
  if (!shaders_) return;
  for (const auto& entry : commit.edits.edits) {
    const auto* made = entry ? entry->any.AsShaderClass() : nullptr;
    if (!made) continue;
    std::string name, path;
    try {
      name = shaders_->libraryOf(made->name, made->library);
      path = shaders_->locate(name);
    } catch (const std::exception&) { continue; }
    if (path.empty() || std::any_of(parcel.libraries.begin(), parcel.libraries.end(),
                                    [&](auto& l) { return l.name == name; }))
      continue;
    parcel.libraries.push_back({.name = name, .hash = files_.of(path)});
  }
}

ParcelPtr Packer::pack(std::shared_ptr<const Commit> commit) {
  if (hashes_.size() + offers_.size() > sweepAt_) {
    std::erase_if(hashes_, [](const auto& entry) { return entry.second.first.expired(); });
    std::erase_if(offers_, [](const auto& entry) { return entry.second.expired(); });
    sweepAt_ = 2 * (hashes_.size() + offers_.size()) + 64;
  }
  auto parcel = std::make_shared<Parcel>();
  parcel->edits = packEdits(commit->edits);
  parcel->bytes = parcel->edits.size();
  std::map<Hash, OfferPtr> distinct;
  for (const auto& [id, array] :
       std::map<ArrayId, ArrayPtr>(commit->arrays.begin(), commit->arrays.end())) {
    if (!array) continue;
    const OfferPtr offer = this->offer(array);
    parcel->arrays.push_back({id, array->size(), offer->hash});
    if (distinct.emplace(offer->hash, offer).second) {
      parcel->offers.push_back(offer);
      parcel->bytes += array->size();
    }
  }
  addLibraries(*commit, *parcel);
  parcel->commit = std::move(commit);
  return parcel;
}

} // namespace openrt::cluster
