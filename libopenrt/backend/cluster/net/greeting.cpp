#include "backend/cluster/net/greeting.h"

#include <unistd.h>

#if defined(__GLIBC__)
#include <gnu/libc-version.h>
#endif

#include "backend/instruction_sets.h"
#include "openrt/openrt.h"
#include "openrt/openrts.h"

namespace openrt::cluster {
namespace {

std::string version() {
  return std::to_string(OPENRT_VERSION_MAJOR) + "." + std::to_string(OPENRT_VERSION_MINOR) + "." +
         std::to_string(OPENRT_VERSION_PATCH);
}

// Returns the C library and its version: its sines and logarithms differ in the last bits between
// versions.
std::string platform() {
#if defined(__GLIBC__)
  return std::string("glibc ") + gnu_get_libc_version();
#else
  return "another C library";
#endif
}

} // namespace

message::Hello identity(const RTstats& local) {
  message::Hello self;
  self.protocol = protocolVersion;
  self.library = version();
  self.api = OPENRT_VERSION_MAJOR << 16 | OPENRT_VERSION_MINOR;
  self.shaderAbi = RTS_ABI_MAJOR << 16 | RTS_ABI_MINOR;
  self.isa = local.machine.isa;
  self.isas = instructionSetsFrom(local.machine.isa);
  self.kernel = local.machine.kernel;
  self.platform = platform();
  char host[256] = "";
  if (gethostname(host, sizeof host - 1) == 0) self.host = host;
  self.process = uint32_t(getpid());
  return self;
}

message::Welcome usualWelcome(uint64_t session) {
  const WireOptions usual;
  return {.protocol = protocolVersion,
          .session = session,
          .heartbeat = float(usual.heartbeat),
          .silence = float(usual.silence)};
}

bool canUse(const message::Hello& machine, const std::string& isa) {
  return machine.isa == isa || listsInstructionSet(machine.isas, isa);
}

std::string difference(const message::Hello& worker, const message::Hello& master, bool tolerant) {
  std::string differing;
  const auto compare = [&](const char* what, const std::string& theirs, const std::string& ours) {
    if (theirs != ours)
      differing += (differing.empty() ? "" : "; ") + std::string(what) + ": the worker has " +
                   theirs + ", the master " + ours;
  };
  compare("protocol", std::to_string(worker.protocol), std::to_string(master.protocol));
  compare("interface of shaders",
          std::to_string(worker.shaderAbi >> 16) + "." + std::to_string(worker.shaderAbi & 0xffff),
          std::to_string(master.shaderAbi >> 16) + "." + std::to_string(master.shaderAbi & 0xffff));
  if (!differing.empty() || tolerant) return differing;
  compare("version", worker.library, master.library);
  compare("interface", std::to_string(worker.api >> 16) + "." + std::to_string(worker.api & 0xffff),
          std::to_string(master.api >> 16) + "." + std::to_string(master.api & 0xffff));
  if (!canUse(worker, master.isa)) {
    compare("instruction set", worker.isa, master.isa);
    if (canUse(master, worker.isa)) differing += " (isa=" + worker.isa + " suits both)";
  }
  compare("ray kernel", worker.kernel, master.kernel);
  compare("system", worker.platform, master.platform);
  if (!differing.empty()) differing += " (tolerant=1 accepts it, but last bits may differ)";
  return differing;
}

} // namespace openrt::cluster
