// rt_objects.h: the C++ side of the Python module xvrml.rt: an OpenRT context and what is in it. A
// context is current on a thread only while a call for it runs there; one call at a time, others
// wait without the GIL.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "gil.h"
#include "openrt/openrt.h"

namespace py = pybind11;

struct RtContext {
  explicit RtContext(const std::string& config);
  ~RtContext(); // no call is under way: each holds it
  void close();
  RTcontext handle = nullptr;
  Awaited<std::mutex> mutex;
  bool dirty = true; // edits that no query has seen yet
  std::atomic<bool> drawing{
      false};            // a picture is made on behalf of the thread that holds the mutex
  std::thread::id owner; // that thread
};
using RtContextPtr = std::shared_ptr<RtContext>;

// Makes the context current on this thread while it lives. [constructed and destroyed with the GIL]
class RtUse {
 public:
  explicit RtUse(const RtContextPtr& context, bool edits = true);
  ~RtUse();
  RtUse(const RtUse&) = delete;
  RtUse& operator=(const RtUse&) = delete;
  // Raises what the calls since the last check have reported.
  void check() const;
  // Makes what was edited known to queries.
  void commit() const;

 private:
  const RtContextPtr context_;
  std::unique_lock<Awaited<std::mutex>> lock_;
  RTcontext before_;
};

struct RtThing { // an object, instance, shader, light or texture
  RtContextPtr context;
  RTid id = 0;
};
struct RtObject : RtThing {};
struct RtInstance : RtThing {};
struct RtTexture : RtThing {};
struct RtLight : RtThing {};
struct RtShader : RtThing {
  RTid shaderClass = 0;
  std::string name;
};

// A 4x4 matrix for column vectors, as on paper; None: the identity. name: of the argument, for
// messages.
std::array<double, 16> rtMatrix(const py::object& rows, const std::string& name = "matrix");

void defineRtScene(py::module_& module);
void defineRtQueries(py::class_<RtContext, RtContextPtr>& context);
void defineRtRender(py::class_<RtContext, RtContextPtr>& context);
