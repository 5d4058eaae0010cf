// cluster.cpp: Implements the Python class Cluster. [GIL held; released while waiting]
#include <chrono>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "cluster_object.h"
#include "libpicture/worker_facts.h"
#include "parameters.h"
#include "render_request.h"

namespace {

// Owned by the module for the life of the interpreter.
PyObject* clusterError = nullptr;
// contextvars.ContextVar: the Cluster of the innermost `with`, or None
PyObject* scope = nullptr;

struct ClusterObject {
  std::shared_ptr<picture::Cluster> cluster; // the connections to the workers; null after close()
  picture::ClusterSettings settings;
  // The world that was rendered last. This world may still hold the context.
  std::weak_ptr<WorldObject> holder;
  std::vector<py::object> tokens; // tokens of the nested `with` scopes, innermost last

  const picture::Cluster& open() const {
    if (!cluster) throw py::value_error("the cluster is closed");
    return *cluster;
  }
};
using ClusterPtr = std::shared_ptr<ClusterObject>;

// Accepts "a:7447,b", ["a:7447", "b"] or "@hosts.txt".
std::string workersOf(const py::object& given) {
  if (given.is_none()) return "";
  if (py::isinstance<py::str>(given)) return fromText(given);
  std::string list;
  for (const py::handle one : given) {
    if (!py::isinstance<py::str>(one))
      throw py::type_error("workers: 'HOST[:PORT]', a list of these or '@FILE' expected");
    const std::string name = fromText(one);
    if (name.empty() || name.find_first_of(", \t\r\n") != name.npos)
      throw py::value_error("workers: 'HOST[:PORT]' expected, not '" + name + "'");
    list += (list.empty() ? "" : ",") + name;
  }
  return list;
}

std::string pathOf(const py::object& given) { return given.is_none() ? "" : toPath(given); }

// The arguments of Cluster(), in the order of Python's signature. The values are the defaults.
struct ClusterArguments {
  py::object workers = py::none();
  py::object key = py::none();
  py::object listen = py::none();
  py::object allowKeys = py::none();
  std::optional<int> localThreads;
  std::string split = "auto";
  int require = 0;
  bool tolerant = false;
  py::object shaderPath = py::none();
  std::string isa = "auto";
};

ClusterPtr make(const ClusterArguments& given) {
  picture::ClusterSettings settings;
  settings.workers = workersOf(given.workers);
  if (!given.listen.is_none()) settings.listen = fromText(given.listen);
  settings.key = pathOf(given.key);
  settings.allow = pathOf(given.allowKeys);
  if (given.localThreads && (*given.localThreads < 0 || *given.localThreads > 1024))
    throw py::value_error("local_threads: 0 to 1024 expected");
  settings.localThreads = given.localThreads.value_or(-1);
  const std::string& split = given.split;
  if (split != "auto" && split != "tiles" && split != "samples" && split != "frames")
    throw py::value_error("split: 'auto', 'tiles', 'samples' or 'frames' expected, not '" + split +
                          "'");
  settings.split = split;
  if (given.require < 0 || given.require > 65536)
    throw py::value_error("require: 0 to 65536 expected");
  settings.require = given.require;
  settings.tolerant = given.tolerant;
  if (!settings.used()) throw py::value_error("Cluster: workers or listen expected");
  picture::RenderSettings context;
  context.shaderPath = pathOf(given.shaderPath);
  context.isa = checkedIsa(given.isa);
  auto made = std::make_shared<ClusterObject>();
  made->settings = settings;
  const ReleaseGil release;
  made->cluster = std::make_shared<picture::Cluster>(settings, context);
  return made;
}

// Makes the world that holds the context return it; this may wait for a picture.
void release(ClusterObject& self) {
  const WorldPtr holder = self.holder.lock();
  self.holder.reset();
  if (!holder) return;
  const auto lock = holder->lock();
  const ReleaseGil released;
  holder->releaseRenderer();
}

void closeCluster(const ClusterPtr& self) {
  release(*self);
  std::shared_ptr<picture::Cluster> last = std::exchange(self->cluster, nullptr);
  const ReleaseGil released;
  last.reset(); // disconnects from the workers
}

ClusterPtr enter(const ClusterPtr& self) {
  self->open();
  self->tokens.push_back(py::handle(scope).attr("set")(self));
  return self;
}

void leave(const ClusterPtr& self, const py::args&) {
  if (!self->tokens.empty()) {
    py::handle(scope).attr("reset")(self->tokens.back());
    self->tokens.pop_back();
  }
  if (self->tokens.empty()) closeCluster(self);
}

std::vector<RTworker> workers(const ClusterPtr& self) { return self->open().workers(); }

void waitFor(const ClusterPtr& self, size_t count, double timeout) {
  const std::shared_ptr<picture::Cluster> cluster = self->cluster;
  self->open();
  bool signalled = false, there = false;
  {
    const ReleaseGil release;
    there = cluster->wait(count, timeout, [&signalled] {
      const AcquireGil acquire;
      if (!acquire) return true;
      return signalled = PyErr_CheckSignals() != 0;
    });
  }
  if (signalled) throw py::error_already_set();
  if (there) return;
  PyErr_SetString(PyExc_TimeoutError, fmt::format("{} of {} workers are there after {:g} s",
                                                  cluster->alive(), count, timeout)
                                          .c_str());
  throw py::error_already_set();
}

std::string text(const ClusterPtr& self) {
  if (!self->cluster) return "<Cluster, closed>";
  return fmt::format("<Cluster of {} workers>", self->cluster->alive());
}

std::string workerText(const RTworker& w) {
  return fmt::format("<Worker {}: {} threads, {} tiles{}>", w.name, w.threads, w.jobs,
                     w.alive ? "" : ", gone");
}

} // namespace

std::shared_ptr<picture::Cluster> clusterFor(const py::object& given, const WorldPtr& world) {
  const py::object chosen = given.is_none() ? py::object(py::handle(scope).attr("get")()) : given;
  if (chosen.is_none()) return nullptr;
  if (!py::isinstance<ClusterObject>(chosen))
    throw py::type_error("cluster: a Cluster or None expected");
  const ClusterPtr cluster = chosen.cast<ClusterPtr>();
  cluster->open();
  if (cluster->holder.lock() != world) release(*cluster);
  cluster->holder = world;
  return cluster->cluster;
}

void defineCluster(py::module_& module) {
  clusterError = PyErr_NewExceptionWithDoc(
      "xvrml.ClusterError", "Raised if workers are missing, or an address or a key is unusable.",
      module.attr("RenderError").ptr(), nullptr);
  if (!clusterError) throw py::error_already_set();
  module.add_object("ClusterError", clusterError);
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const picture::RenderError& error) {
      if (error.code != RT_CLUSTER_ERROR) throw;
      PyErr_SetString(clusterError, error.what());
    }
  });
  scope = py::module_::import("contextvars")
              .attr("ContextVar")("xvrml_cluster", py::arg("default") = py::none())
              .release()
              .ptr();

  py::class_<RTworker> worker(module, "Worker",
                              "Statistics of one machine of a cluster since it joined.");
  picture::forEachWorkerFact([&](const picture::WorkerFact& fact, auto get) {
    worker.def_property_readonly(
        fact.attribute,
        [get](const RTworker& w) {
          const auto value = std::invoke(get, w);
          if constexpr (std::is_pointer_v<decltype(value)>)
            return toText(value);
          else
            return value;
        },
        fact.help);
  });
  worker.def("__repr__", workerText);
  py::class_<ClusterObject, ClusterPtr> cluster(
      module, "Cluster",
      "Machines that render together: `with Cluster([\"a:7447\", \"b\"], key=\"cluster.key\")`. "
      "Renders inside the with block use them. Pictures have the same bytes as without a cluster "
      "(docs/cluster.md).");
  using A = ClusterArguments;
  defineConstructor(
      cluster, make, parameterList(parameter("workers", &A::workers)),
      parameterList(parameter("key", &A::key), parameter("listen", &A::listen),
                    parameter("allow_keys", &A::allowKeys),
                    parameter("local_threads", &A::localThreads), parameter("split", &A::split),
                    parameter("require", &A::require), parameter("tolerant", &A::tolerant),
                    parameter("shader_path", &A::shaderPath), parameter("isa", &A::isa)),
      "Starts connecting and returns at once. workers: addresses of workers that run with "
      "--listen, or '@FILE'. listen: the address to which workers that run with --connect connect. "
      "require: renders raise ClusterError if fewer workers are connected for 10 seconds. isa: "
      "instruction set of the ray kernels on all machines ('avx2', ...); one that lacks it is "
      "refused.");
  cluster.def("__enter__", enter)
      .def("__exit__", leave)
      .def("close", closeCluster,
           "Disconnects from the workers. The end of the with block calls it.")
      .def_property_readonly("workers", workers,
                             "A Worker for each machine that has joined, including machines that "
                             "have left and this one.")
      .def("wait", waitFor, py::arg("count").noconvert() = 1, py::arg("timeout") = 10.0,
           "Waits until `count` workers have joined. Raises TimeoutError after `timeout` seconds. "
           "Renders work without waiting, because workers may join while a picture is rendered.")
      .def("__repr__", text);
}
