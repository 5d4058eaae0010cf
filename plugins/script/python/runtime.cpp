#include "runtime.h"

#include <cstdlib>
#include <filesystem>
#include <mutex>

#include <dlfcn.h>

#include "memory.h"
#include "plugin_files.h"
#include "system/libraries.h"

namespace python {
namespace {

namespace fs = std::filesystem;

unsigned long mainThread = 0; // Python's identifier of the thread
bool startedHere = false;

// Makes Python's symbols global, because its extension modules expect them in the whole program.
void shareSymbols() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&Py_IsInitialized), &info) != 0 && info.dli_fname)
    dlopen(info.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
}

// Returns the program name from which Python derives the place of its library: an activated
// environment of the same version, which no other user could have written, otherwise the Python of
// the build.
std::string programName() {
  const char* environment = os::trustedEnvironment("VIRTUAL_ENV");
  const std::string version =
      std::to_string(PY_MAJOR_VERSION) + "." + std::to_string(PY_MINOR_VERSION);
  // A relative path would mean whatever lies in the folder in which the program was started.
  if (environment && *environment == '/' &&
      plugin_files::trusted(fs::path(environment) / "lib" / ("python" + version)))
    return (fs::path(environment) / "bin/python3").string();
  return fs::exists(PYTHON_PROGRAM) ? PYTHON_PROGRAM : "python3";
}

void check(const PyStatus& status) {
  if (PyStatus_Exception(status))
    throw StartError(std::string("Python cannot start: ") +
                     (status.err_msg ? status.err_msg : "exit"));
}

struct Config {
  PyConfig config;
  Config() { PyConfig_InitPythonConfig(&config); }
  ~Config() { PyConfig_Clear(&config); }
};

void initialize() {
  shareSymbols();
  PyPreConfig before;
  PyPreConfig_InitPythonConfig(&before);
  before.configure_locale = 0; // the host owns the locale
  before.coerce_c_locale = 0;
  before.utf8_mode = 1;
  check(Py_PreInitialize(&before));
  countMemory();
  Config c;
  c.config.install_signal_handlers = 0;
  c.config.parse_argv = 0;
  c.config.configure_c_stdio = 0;
  // The order of sets, and with it the pictures, must be the same in every run.
  if (!std::getenv("PYTHONHASHSEED")) {
    c.config.use_hash_seed = 1;
    c.config.hash_seed = 0;
  }
  check(PyConfig_SetBytesString(&c.config, &c.config.program_name, programName().c_str()));
  check(Py_InitializeFromConfig(&c.config));
  // Standard output may carry a picture, so print() outside of Scripts goes to standard error.
  if (PyObject* errors = PySys_GetObject("stderr")) PySys_SetObject("stdout", errors);
  if (PyRun_SimpleString("import random\nrandom.seed(0)") != 0)
    throw StartError("Python cannot start: no module random");
  mainThread = PyThread_get_thread_ident();
  startedHere = true;
  PyEval_SaveThread(); // release the lock
}

// Returns the package folders of the tree in which this library is installed or built.
std::vector<std::string> packageFolders() {
  static const char here = 0;
  Dl_info info{};
  std::vector<std::string> found;
  std::error_code error;
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return found;
  const fs::path folder = fs::canonical(info.dli_fname, error).parent_path();
  for (const char* place : {"../../openrt/python", "../../../python"}) {
    const fs::path candidate = fs::canonical(folder / place, error);
    if (!error && fs::is_directory(candidate / "xvrml", error)) found.push_back(candidate.string());
  }
  return found;
}

py::module_ importBinding() {
  py::list path = py::module_::import("sys").attr("path");
  const std::vector<std::string> folders = packageFolders();
  // Prefer the package that was built with the host's library. It stays first only during the
  // import.
  for (auto i = folders.rbegin(); i != folders.rend(); ++i) path.insert(0, *i);
  py::object module;
  std::string why;
  try {
    module = py::module_::import("xvrml._xvrml");
  } catch (py::error_already_set& error) { why = py::str(error.value()); }
  for (const std::string& folder : folders) path.attr("remove")(folder);
  if (!module)
    throw StartError(
        "the Python package xvrml, whose nodes Scripts in Python use, cannot be imported: " + why);
  if (!py::hasattr(module, "_script_node"))
    throw StartError("the Python package xvrml is another version's: " +
                     std::string(py::str(module.attr("__file__"))));
  return module;
}

} // namespace

void startPython() {
  static std::mutex mutex;
  static std::string failure;
  const std::scoped_lock lock(mutex);
  if (!failure.empty()) throw StartError(failure);
  if (mainThread != 0) return;
  try {
    if (!Py_IsInitialized()) return initialize();
    const Gil gil;
    countMemory();
    mainThread =
        py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  } catch (const std::exception& error) {
    failure = error.what();
    throw StartError(failure);
  }
}

py::module_ binding() {
  static PyObject* known = nullptr; // lives as long as the interpreter
  if (!known) known = importBinding().release().ptr();
  return py::reinterpret_borrow<py::module_>(known);
}

bool isProgram() { return !startedHere; }
bool isMainThread() { return PyThread_get_thread_ident() == mainThread; }

} // namespace python
