// validate_arrays.h: checks of the bulk data that edits name. Used by the validator; pure functions
// that throw std::runtime_error.
#pragma once

#include "openrt/openrts.h"
#include "scene/commit.h"

namespace openrt {

// Arrays of a geometry must travel with its commit, fit each other and hold finite numbers and
// indices within the points.
void checkGeometryArrays(const edit::GeometryT& geometry, const Commit& commit);

// A parameter's values by vertex or by primitive of a geometry whose arrays are good: sizes,
// finite, within the range. param: what its class declares; null: unknown.
void checkParameterValues(const edit::GeometryT& geometry, const edit::GeometryParameterT& own,
                          const Commit& commit, const RtsParam* param);

// Texels travel with the commit, or are the ones that the texture has already (current: its last
// edit; null: none).
void checkTexture(const edit::TextureT& texture, const Commit& commit,
                  const edit::TextureT* current);

} // namespace openrt
