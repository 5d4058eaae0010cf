// edits_bytes.h: the edits of a commit as bytes (edits.fbs), for recordings and for workers. Bytes
// may come from anywhere: what is read is verified; what it means is the validator's to check. Pure
// functions that throw std::runtime_error. [any]
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/commit.h"

namespace openrt {

std::vector<std::byte> packEdits(const edit::EditsT& edits);
void unpackEdits(std::span<const std::byte> bytes, edit::EditsT& edits);

} // namespace openrt
