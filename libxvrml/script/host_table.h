// host_table.h: the function table of Scripts; the functions are in host_table.cpp and
// host_scene.cpp.
#pragma once

#include "script/host.h"

namespace xvrml {

struct ScriptHost::Table : XsHost {
  explicit Table(ScriptHost& host);
  ScriptHost& host;
};

} // namespace xvrml
