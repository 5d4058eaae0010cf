// edits_bytes.h: converts the edits of a commit to and from bytes (edits.fbs), for recordings and
// workers. unpackEdits verifies the bytes, because they may come from any source; the validator
// checks their meaning. Pure functions that throw std::runtime_error. [any]
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/commit.h"

namespace openrt {

std::vector<std::byte> packEdits(const edit::EditsT& edits);
void unpackEdits(std::span<const std::byte> bytes, edit::EditsT& edits);

} // namespace openrt
