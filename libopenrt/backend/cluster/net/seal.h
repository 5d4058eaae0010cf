// seal.h: the last frame of every message: its number and a checksum, so that one that was lost,
// repeated or damaged on the way is noticed whatever carries it (docs/protocol.md, "Seals"). The
// Wire puts them on and takes them off.
#pragma once

#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

// Of the message with this number of its peer and direction, counted from 1: appended to its
// frames.
void seal(Frames& frames, uint64_t number);
// Takes the seal off. False: it is not that of this message; the frames are of no use.
bool unseal(Frames& frames, uint64_t number);

} // namespace openrt::cluster
