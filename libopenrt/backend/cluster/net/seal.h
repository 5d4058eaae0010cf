// seal.h: the last frame of every message: its number and a checksum. It detects messages that were
// lost, repeated or damaged, whatever transport carries them (docs/protocol.md, "Seals"). The Wire
// adds and removes seals.
#pragma once

#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

// Appends the seal of a message to its frames. number: counts the messages of one peer and
// direction from 1.
void seal(Frames& frames, uint64_t number);
// Removes the seal. Returns false if it does not belong to this message; the frames are then
// useless.
bool unseal(Frames& frames, uint64_t number);

} // namespace openrt::cluster
