// vrml1.h: reads a file in VRML 1.0 (G. Bell, A. Parisi, M. Pesce: The Virtual Reality Modeling
// Language, Version 1.0 Specification, 26 May 1995) as the VRML97 graph that means the same. Called
// by the loader, on its thread.
#pragma once

#include "base/locator.h"
#include "graph/load_state.h"

namespace xvrml {

// Fills the file's scope and the list of its Inlines. Faults are reported; limits are those
// of the world. `depthLimit`: greatest nesting of nodes that the thread's stack allows.
void readVrml1(Locator& locator, LoadState& state, ParsedFile& file, uint64_t depthLimit);

} // namespace xvrml
