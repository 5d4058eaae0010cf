// cluster_options.cpp: Defines the options of the group Cluster, a part of the table of options
// (option_info.h).
#include "option_info.h"

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

constexpr const char* clusterNeeds = "--workers and --listen-workers need {}";

const OptionInfo table[] = {
    {"--workers", "HOST[:PORT],...|@FILE", "Cluster",
     "Share the rendering with these machines; openrt-worker --listen must run on each (default "
     "port 7447). @FILE reads the list from a file with one machine per line; # begins a comment. "
     "The picture has the same bytes for any number of machines, even if some of them fail "
     "(docs/cluster.md).",
     [](Options& o, const std::string& v) {
       o.cluster.workers = given(v, "HOST[:PORT],... or @FILE");
     },
     with(needs("-o,the window,vv serve", clusterNeeds))},
    {"--listen-workers", "ADDRESS[:PORT]", "Cluster",
     "Wait at this address for workers that connect (openrt-worker --connect). 0.0.0.0 is every "
     "address of this machine.",
     [](Options& o, const std::string& v) { o.cluster.listen = given(v, "ADDRESS[:PORT]"); },
     with(needs("-o,the window,vv serve", clusterNeeds))},
    {"--key", "FILE", "Cluster",
     "Key file, the same one that the workers have (openrt-worker --new-key FILE makes one). "
     "Without a key, only loopback addresses can be used.",
     [](Options& o, const std::string& v) { o.cluster.key = given(v, "a file name"); },
     with(needs("--workers,--listen-workers,--control",
                "--key needs --workers or --listen-workers"))},
    {"--allow-keys", "FILE", "Cluster",
     "File with public keys of further workers to accept, one per line. Workers with the same key "
     "file are always accepted.",
     [](Options& o, const std::string& v) { o.cluster.allow = given(v, "a file name"); },
     with(needs("--workers,--listen-workers,--control",
                "--allow-keys needs --workers or --listen-workers"),
          needs("--key"))},
    {"--local-threads", "N", "Cluster",
     "Number of threads of this machine that render beside the workers (default: as --threads). "
     "With 0, this machine renders only if no worker is connected.",
     [](Options& o, const std::string& v) {
       o.cluster.localThreads = int(readInteger(v, 0, 1024));
     },
     with(needs("--workers,--listen-workers"))},
    {"--split", "auto|tiles|samples|frames", "Cluster",
     "How to divide the work: into tiles of a picture, into samples, or into whole pictures of a "
     "sequence. auto (default) decides for each task. The pictures have the same bytes in every "
     "case.",
     setSplit, with(needs("--workers,--listen-workers"))},
    {"--require-workers", "[N]", "Cluster",
     "Stop with exit code 6 if fewer than N workers (default 1) are connected for 10 seconds. "
     "Without this option, this machine finishes the picture alone.",
     [](Options& o, const std::string& v) {
       o.cluster.require = v.empty() ? 1 : int(readInteger(v, 1, 65536));
     },
     with(needs("--workers,--listen-workers"))},
    {"--tolerant", "", "Cluster",
     "Accept workers with another instruction set or version. The last digits of a picture may "
     "then differ from run to run.",
     [](Options& o, const std::string&) { o.cluster.tolerant = true; },
     with(needs("--workers,--listen-workers"))},
};

} // namespace

std::span<const OptionInfo> clusterOptions() { return table; }

} // namespace vv
