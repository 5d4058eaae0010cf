// report.h: Builds the report of a world: a page with its picture, what its probes read, what has
// been edited and how to make the picture again; and the same numbers as a table. Pure functions.
// [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "edit/probes.h"
#include "xvrml/edit.h"

namespace vv {

struct ReportPicture {
  std::string title;
  std::string png; // the bytes of the file
  int width = 0, height = 0;
  std::string command; // makes the picture again; empty: there is none
};

struct Report {
  std::string world;      // the name of its file
  std::string program;    // "vv 0.2.0"
  bool isUnsaved = false; // there are edits that are not in the file
  uint64_t problems = 0;  // errors and warnings
  std::vector<ReportPicture> pictures;
  std::vector<Probe> probes;
  std::vector<std::optional<Difference>> changes; // one for each probe
  std::vector<xvrml::ChangedField> fields;
};

// Returns a page of HTML that needs no other file and runs no program. Everything that comes from
// the world is escaped.
std::string reportPage(const Report& report);
// Returns a table (CSV) with a line for each picture, probe and changed field.
std::string reportTable(const Report& report);

} // namespace vv
