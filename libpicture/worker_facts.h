// worker_facts.h: the one table of what users see of a worker of a cluster. The statistics and the
// table of machines of vv (apps/vv/report) and xvrml.Worker (bindings/python/cluster.cpp) follow
// from it. [any thread]
#pragma once

#include "libpicture/cluster.h"

namespace picture {

// How the table of vv -v prints a number.
enum class FactUnit { none, million, bytes, milliseconds, seconds };

struct WorkerFact {
  const char* attribute;       // attribute in Python
  const char* key = attribute; // key in the JSON of vv --stats
  const char* help = "";       // docstring of the attribute
  // Heading of a column in the table of vv -v, or a word that stands after a number other than 0 at
  // the end of the line. Facts without both are not printed.
  const char *heading = "", *note = "";
  FactUnit unit = FactUnit::none;
  int width = 9;       // width of the column
  bool ofLink = false; // the column is blank for this process, which has no link
};

// Calls f(WorkerFact, get) for each row. std::invoke(get, worker) returns the value: a bool, a
// number or a const char*. The columns of vv -v and the members of the JSON have the order of the
// rows. Attributes of Python need a property in bindings/python/xvrml/__init__.pyi, too.
template <class F> void forEachWorkerFact(F&& f) {
  using Unit = FactUnit;
  f({.attribute = "name", .help = "Host and address; 'here': this process."},
    [](const RTworker& w) -> const char* { return w.name; });
  f({.attribute = "here"}, isHere);
  f({.attribute = "alive", .help = "False: it has left, or was refused."},
    [](const RTworker& w) { return w.alive != 0; });
  f({.attribute = "threads", .heading = "threads", .width = 7}, &RTworker::threads);
  f({.attribute = "tiles",
     .help = "Jobs done: tiles, or parts of their samples.",
     .heading = "jobs"},
    &RTworker::jobs);
  f({.attribute = "rays", .heading = "Mray", .unit = Unit::million}, &RTworker::rays);
  f({.attribute = "bytes_sent", .heading = "sent", .unit = Unit::bytes, .ofLink = true},
    &RTworker::bytesSent);
  f({.attribute = "bytes_received", .heading = "received", .unit = Unit::bytes, .ofLink = true},
    &RTworker::bytesReceived);
  f({.attribute = "late",
     .help = "Results that came when somebody else had done the job.",
     .note = "late"},
    &RTworker::late);
  f({.attribute = "lost", .help = "Jobs that were taken away because it left.", .note = "lost"},
    &RTworker::lost);
  f({.attribute = "latency",
     .help = "Seconds that a job is under way beyond the work.",
     .heading = "latency",
     .unit = Unit::milliseconds,
     .ofLink = true},
    &RTworker::latency);
  f({.attribute = "busy_seconds",
     .key = "busy",
     .help = "Of all its threads.",
     .heading = "busy",
     .unit = Unit::seconds},
    &RTworker::busySeconds);
}

} // namespace picture
