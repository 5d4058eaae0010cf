// openrt_worker.cpp: the program openrt-worker: lends this machine's threads to masters
// (backend=cluster, vv --workers). This file handles options and signals;
// backend/cluster/worker/serve.h does the work. Exit codes: 0 done (also by SIGTERM), 1 something
// failed, 2 usage, 3 key file missing or unusable, 75 port in use or out of memory, 130 by SIGINT.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "backend/cluster/net/keys.h"
#include "backend/cluster/net/metrics_server.h"
#include "backend/cluster/worker/serve.h"
#include "enough_stack.h"
#include "nearest.h"
#include "openrt/openrt.h"
#include "option_words.h"
#include "output_written.h"
#include "printable.h"
#include "shading/registry.h"

namespace {

using namespace openrt;
using namespace openrt::cluster;

enum ExitCode {
  Done = 0,
  Failed = 1,
  Usage = 2,
  KeysUnusable = 3,
  TryAgain = 75,
  Interrupted = 130
};

constexpr const char* defaultAddress = "127.0.0.1:7447";
constexpr const char* defaultShare = "127.0.0.1:0";
constexpr const char* metricsPort = ":9447";
constexpr unsigned graceSeconds = 1; // seconds from a signal to a forced exit

struct Options {
  std::string listen, connect, key, allow, newKey, shaderPath, folder, share, metrics;
  uint32_t threads = 0;
  size_t cache = 1024, folderSize = 10240; // MB
  bool once = false, quiet = false;
};

// Used by the signal handler, which may run on any thread.
std::atomic<WorkerService*> service{nullptr};
std::atomic<int> signalled{0};
static_assert(std::atomic<int>::is_always_lock_free &&
              std::atomic<WorkerService*>::is_always_lock_free);

extern "C" void onSignal(int number) {
  WorkerService* const running = service;
  int first = 0;
  if (number == SIGALRM || !running || !signalled.compare_exchange_strong(first, number))
    _exit(signalled == SIGTERM || number == SIGTERM ? Done : Interrupted);
  alarm(graceSeconds);
  running->stop();
}

int reportError(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "openrt-worker: error: %s\n", printable(message).c_str());
  return code;
}

// Returns the address with a port: that of the address, if it has one.
std::string withPort(const std::string& address, const std::string& port) {
  const size_t end = address.rfind(']'), colon = address.rfind(':');
  const bool has = colon != address.npos && (end == address.npos || colon > end);
  return has ? address : address + port;
}

std::string unknownArgument(const CLI::App& app, const std::string& argument) {
  if (!argument.starts_with('-')) return "\"" + argument + "\" was not expected";
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::string near = nearest::word(argument.substr(0, argument.find('=')), names);
  return "there is no option " + argument +
         (near.empty() ? "; openrt-worker --help lists them" : "; did you mean " + near + "?");
}

void declareOptions(CLI::App& app, Options& o) {
  const auto megabytes = CLI::Range(size_t(0), size_t(1) << 24);
  auto* listen = app.add_option("--listen", o.listen,
                                "wait for masters at [ADDRESS][:PORT] (default 127.0.0.1:7447; "
                                "port 0: any that is free)")
                     ->expected(0, 1);
  app.add_option("--connect", o.connect,
                 "connect to a master that listens at HOST[:PORT], and again whenever it has left")
      ->excludes(listen);
  app.add_option("--key", o.key,
                 "key file, needed for other machines: the same one as on the other side, or one "
                 "that it allows");
  app.add_option("--allow", o.allow, "file with further public keys to accept, one per line");
  app.add_option(
      "--new-key", o.newKey,
      "write a new key file, print its public key, and exit; existing files are never overwritten");
  app.add_option("--threads", o.threads,
                 "number of render threads (default: as many as the process may use)")
      ->check(CLI::Range(0, 1024));
  app.add_option("--shader-path", o.shaderPath,
                 "folders with shader libraries, separated by colons");
  app.add_option("--cache", o.cache,
                 "megabytes of arrays to keep for the next scene (default 1024)")
      ->check(megabytes);
  auto* folder = app.add_option("--cache-folder", o.folder,
                                "keep arrays in this folder, too; workers of one user may use one "
                                "together, also on a shared disk");
  app.add_option("--cache-folder-size", o.folderSize,
                 "megabytes that the folder may have (default 10240)")
      ->check(megabytes)
      ->needs(folder);
  app.add_option("--share", o.share,
                 "pass arrays on to other workers of a master, which ask at [ADDRESS][:PORT] "
                 "(default 127.0.0.1:0; port 0: any that is free)")
      ->expected(0, 1)
      ->needs(folder);
  app.add_option("--metrics", o.metrics,
                 "answer Prometheus at http://[ADDRESS][:PORT]/metrics (default 127.0.0.1:9447)")
      ->expected(0, 1);
  app.add_flag("--once", o.once, "exit when the first master has left");
  app.add_flag("-q,--quiet", o.quiet, "print errors only");
  app.set_version_flag("--version", std::string("openrt-worker ") +
                                        std::to_string(OPENRT_VERSION_MAJOR) + "." +
                                        std::to_string(OPENRT_VERSION_MINOR) + "." +
                                        std::to_string(OPENRT_VERSION_PATCH));
  app.allow_extras(); // an unknown option gets a message with a suggestion
}

std::optional<Options> parseOptions(int argc, char** argv, int& exitCode) {
  Options o;
  CLI::App app("Renders parts of pictures for masters on other machines.", "openrt-worker");
  declareOptions(app, o);
  try {
    app.parse(optionWords(argc, argv, app));
    // An empty value, perhaps of a variable that is not set, must not mean that there is none.
    for (const auto& [name, value] :
         {std::pair<const char*, const std::string*>{"--connect", &o.connect},
          {"--key", &o.key},
          {"--allow", &o.allow},
          {"--cache-folder", &o.folder},
          {"--new-key", &o.newKey}})
      if (app.count(name) > 0 && value->empty())
        throw CLI::ValidationError(name, "a value was expected, not \"\"");
    if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty()) {
      exitCode = reportError(Usage, unknownArgument(app, unknown[0]));
      return std::nullopt;
    }
    if (!o.allow.empty() && o.key.empty()) throw CLI::ValidationError("--allow", "needs --key");
  } catch (const CLI::ParseError& e) {
    exitCode =
        e.get_exit_code() == 0 ? app.exit(e, std::cout, std::cerr) : reportError(Usage, e.what());
    return std::nullopt;
  }
  if (o.connect.empty() && o.listen.empty()) o.listen = defaultAddress;
  if (app.count("--share") > 0 && o.share.empty()) o.share = defaultShare;
  if (app.count("--metrics") > 0) o.metrics = withPort(o.metrics, metricsPort);
  return o;
}

void report(bool quiet, int level, const std::string& text) {
  static const char* const names[] = {"debug", "info", "warning", "error"};
  if (level >= (quiet ? 3 : 1))
    std::fprintf(stderr, "openrt-worker: %s: %s\n", names[level > 3 ? 3 : level],
                 printable(text).c_str());
}

// Returns the exit code of a command that only prints.
int printed() {
  return outputWritten() ? int(Done) : reportError(Failed, "standard output cannot be written");
}

int newKey(const std::string& path) {
  try {
    std::printf("%s\n", makeKeyFile(path).c_str());
    return printed();
  } catch (const std::exception& e) { return reportError(KeysUnusable, e.what()); }
}

int serve(const Options& o) {
  ServeOptions options;
  try {
    if (!o.key.empty()) options.wire.keys = readKeys(o.key, o.allow);
  } catch (const std::exception& e) { return reportError(KeysUnusable, e.what()); }
  options.wire.listen = o.listen;
  if (!o.connect.empty()) options.wire.connect = {o.connect};
  const ShaderRegistry shaders(shaderFolders(o.shaderPath));
  options.backend.threads = o.threads;
  options.backend.shaders = &shaders;
  options.cacheBytes = o.cache << 20;
  options.folder = o.folder;
  options.folderBytes = uint64_t(o.folderSize) << 20;
  options.share = o.share;
  options.once = o.once;
  options.log = [quiet = o.quiet](int level, const std::string& text) {
    report(quiet, level, text);
  };
  WorkerService worker(options);
  std::optional<MetricsServer> metrics;
  if (!o.metrics.empty()) metrics.emplace(o.metrics, [&worker] { return worker.metrics(); });
  service = &worker;
  if (!o.quiet) {
    const char* how =
        options.wire.keys.empty() ? "without keys, for this machine only" : "with keys";
    if (o.connect.empty())
      std::printf("listening at %s (%s)\n", worker.address().c_str(), how);
    else
      std::printf("calling %s (%s)\n", o.connect.c_str(), how);
    if (metrics) std::printf("metrics at http://%s/metrics\n", metrics->address().c_str());
    std::fflush(stdout);
  }
  worker.run();
  service = nullptr; // from here on a signal ends the program at once
  return signalled && signalled != SIGTERM ? Interrupted : Done;
}

// Runs the program and reports errors. Returns the exit code.
int run(int argc, char** argv) {
  int exitCode = Done;
  try {
    const std::optional<Options> options = parseOptions(argc, argv, exitCode);
    if (!options) return exitCode == Done ? printed() : exitCode;
    return options->newKey.empty() ? serve(*options) : newKey(options->newKey);
  } catch (const std::system_error& e) {
    return reportError(TryAgain, e.what());
  } catch (const std::bad_alloc&) {
    return reportError(TryAgain, "out of memory");
  } catch (const std::runtime_error& e) {
    return reportError(Usage, e.what());
  } catch (const std::exception& e) { return reportError(Failed, e.what()); }
}

} // namespace

int main(int argc, char** argv) {
  for (int number : {SIGINT, SIGTERM, SIGALRM}) std::signal(number, onSignal);
  if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN); // nohup
  std::signal(SIGPIPE, SIG_IGN);
  return withEnoughStack([&] { return run(argc, argv); });
}
