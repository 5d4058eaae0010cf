// validate_arrays.h: checks the bulk data of edits. Used by the validator. Pure functions that
// throw std::runtime_error.
#pragma once

#include "openrt/openrts.h"
#include "scene/commit.h"

namespace openrt {

// Checks the arrays of a geometry: they belong to its commit, fit each other, hold finite numbers,
// and the indices lie within the points.
void checkGeometryArrays(const edit::GeometryT& geometry, const Commit& commit);

// Checks the values of a parameter per vertex or per primitive: their size, finiteness and range.
// The geometry's arrays must have passed checkGeometryArrays. param: declaration of the parameter's
// class; null: unknown.
void checkParameterValues(const edit::GeometryT& geometry, const edit::GeometryParameterT& own,
                          const Commit& commit, const RtsParam* param);

// Checks a texture: its texels belong to the commit, or are those that it already has. current: its
// last edit; null: none.
void checkTexture(const edit::TextureT& texture, const Commit& commit,
                  const edit::TextureT* current);

} // namespace openrt
