// inline.h: content of Inline nodes (clause 6.25) that comes while the world runs. [the browser's
// thread]
#pragma once

#include "event/engine.h"

namespace xvrml {

// Reads the content of an Inline anew, from the urls it has now. False if there is none.
bool loadInlineContent(Engine& engine, Node& inlineNode);
// All Inlines below the roots of a scope that have none, as long as some bring in others. Returns
// how many were loaded.
uint64_t loadInlinesBelow(Engine& engine, const Scope& scope);

} // namespace xvrml
