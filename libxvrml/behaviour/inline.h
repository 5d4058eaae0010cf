// inline.h: loads the content of Inline nodes (clause 6.25) while the world runs. [the browser's
// thread]
#pragma once

#include "event/engine.h"

namespace xvrml {

// Reloads the content of an Inline from its current urls. Returns false if it has no content then.
bool loadInlineContent(Engine& engine, Node& inlineNode);
// Loads all Inlines without content below the roots of a scope, and those in the new content.
// Returns how many were loaded.
uint64_t loadInlinesBelow(Engine& engine, const Scope& scope);

} // namespace xvrml
