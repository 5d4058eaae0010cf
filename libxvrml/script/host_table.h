// host_table.h: the table of functions that Scripts get. See host_table.cpp.
#pragma once

#include "script/host.h"

namespace xvrml {

struct ScriptHost::Table : XsHost {
  explicit Table(ScriptHost& host);
  ScriptHost& host;
};

} // namespace xvrml
