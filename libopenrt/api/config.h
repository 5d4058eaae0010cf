// config.h: the options of a context, read from the text that rtNewContext takes. Application
// thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "backend/backend.h"

namespace openrt {

enum class BackendKind { Local, Null, Record, Cluster };

struct ContextConfig {
  BackendKind backend = BackendKind::Local;
  bool debug = false; // debug:NAME
  uint32_t threads = 0;
  std::string file;       // the recording of backend=record
  std::string record;     // a recording made beside another backend
  std::string shaderPath; // colon-separated folders
  ClusterOptions cluster;

  // Sets one option; throws ApiError for an unknown key or an impossible value.
  void set(std::string_view key, std::string_view value);
  // What no single option can show: throws ApiError.
  void check() const;

 private:
  bool setCluster(std::string_view key, std::string_view value); // false: no such key
  std::string clusterKey_; // one that only backend=cluster has; empty: none was set
};

// Reads blank-separated key=value pairs; a value with blanks stands in double quotes.
ContextConfig parseConfig(std::string_view text);

} // namespace openrt
