// config.h: Holds the options of a context, parsed from the text passed to rtNewContext. Called on
// the application's thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "backend/backend.h"
#include "backend/instruction_sets.h"

namespace openrt {

enum class BackendKind { Local, Null, Record, Cluster };

struct ContextConfig {
  BackendKind backend = BackendKind::Local;
  bool debug = false;            // backend=debug:NAME
  uint32_t threads = 0;          // 0: as many as the process may use
  std::string isa{automaticIsa}; // instruction set of the ray kernels
  std::string file;              // the recording of backend=record
  std::string record;            // a recording that is written while another backend renders
  std::string shaderPath;        // colon-separated folders
  bool lightSamples = true;      // whether light is sampled at shapes and in the sky
  ClusterOptions cluster;

  // Sets one option. Throws ApiError for an unknown key or an invalid value.
  void set(std::string_view key, std::string_view value);
  // Checks the options against each other. Throws ApiError.
  void check() const;

 private:
  bool setCluster(std::string_view key, std::string_view value); // returns false for unknown keys
  std::string clusterKey_; // a key that was set and needs backend=cluster; empty: none
};

// Parses blank-separated key=value pairs. A value that contains blanks is in double quotes.
ContextConfig parseConfig(std::string_view text);

} // namespace openrt
