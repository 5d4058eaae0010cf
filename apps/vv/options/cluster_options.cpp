// cluster_options.cpp: Defines the options of the group Cluster, a part of the table of options
// (options.h).
#include "options.h"

#include <fmt/format.h>

namespace vv {

namespace {

std::string given(const std::string& value, const char* what) {
  if (value.empty() || value == "@") throw UsageError(fmt::format("{} was expected", what));
  return value;
}

void setSplit(Options& o, const std::string& v) {
  if (v != "auto" && v != "tiles" && v != "samples" && v != "frames")
    throw UsageError(fmt::format("auto, tiles, samples or frames was expected, not \"{}\"", v));
  o.cluster.split = v;
}

const OptionInfo table[] = {
    {"--workers", "HOST[:PORT],...|@FILE", "Cluster",
     "Machines that render, too: an openrt-worker listens there (port 7447 where none is said). "
     "@FILE: a file with one a line, # begins a comment. The picture has the same bytes however "
     "many there are, and whatever becomes of them (docs/cluster.md).",
     [](Options& o, const std::string& v) {
       o.cluster.workers = given(v, "HOST[:PORT],... or @FILE");
     }},
    {"--listen-workers", "ADDRESS[:PORT]", "Cluster",
     "Workers call in here (openrt-worker --connect): 0.0.0.0 is every address of this machine.",
     [](Options& o, const std::string& v) { o.cluster.listen = given(v, "ADDRESS[:PORT]"); }},
    {"--key", "FILE", "Cluster",
     "The key file that workers have, too (openrt-worker --new-key FILE makes one). Without one "
     "only loopback addresses are used.",
     [](Options& o, const std::string& v) { o.cluster.key = given(v, "a file name"); }},
    {"--allow-keys", "FILE", "Cluster",
     "Public keys of workers that are let in beside those with the same key file, one a line.",
     [](Options& o, const std::string& v) { o.cluster.allow = given(v, "a file name"); }},
    {"--local-threads", "N", "Cluster",
     "Threads of this machine that render beside the workers (default: as --threads); 0: none as "
     "long as a worker lives.",
     [](Options& o, const std::string& v) {
       o.cluster.localThreads = int(readInteger(v, 0, 1024));
     }},
    {"--split", "auto|tiles|samples|frames", "Cluster",
     "What the work is cut into: tiles of a picture, samples, or whole pictures of a sequence "
     "(default auto: by what is to be done). The bytes are the same.",
     setSplit},
    {"--require-workers", "[N]", "Cluster",
     "Without N workers (default 1) there is no picture: exit code 6 when they are missing for 10 "
     "seconds. Else this machine finishes alone.",
     [](Options& o, const std::string& v) {
       o.cluster.require = v.empty() ? 1 : int(readInteger(v, 1, 65536));
     }},
    {"--tolerant", "", "Cluster",
     "Take workers of another instruction set or version, too: the last digits of a picture may "
     "then differ from run to run.",
     [](Options& o, const std::string&) { o.cluster.tolerant = true; }},
};

} // namespace

std::span<const OptionInfo> clusterOptions() { return table; }

} // namespace vv
