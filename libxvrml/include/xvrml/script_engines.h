// script_engines.h: whether Scripts can run here: which engines (xscript.h) are installed. [one thread at a time]
#pragma once

#include <string_view>

namespace xvrml {

// True if an engine serves the protocol: the scheme of a Script's url ("javascript"), or a file's suffix (".js"). folders:
// separated by colons, before $XVRML_SCRIPT_PATH and the installed ones. Loads engines; says nothing of refused ones.
bool hasScriptEngine(std::string_view protocol, std::string_view folders = {});

} // namespace xvrml
