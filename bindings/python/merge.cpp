// merge.cpp: Implements merge(), which does what vv merge does: it adds pictures of different seeds
// from files that hold their sums. [GIL held]
#include <filesystem>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/files/atomic_file.h"
#include "libpicture/sums_merge.h"
#include "merge.h"
#include "picture_object.h"

namespace {

std::vector<std::string> pathsOf(const py::object& files) {
  constexpr const char* expected = "files: a list of file names was expected";
  if (py::isinstance<py::str>(files) || py::isinstance<py::bytes>(files) ||
      !py::isinstance<py::iterable>(files))
    throw py::type_error(fmt::format("{}, not {}", expected, Py_TYPE(files.ptr())->tp_name));
  std::vector<std::string> paths;
  for (const py::handle file : files) paths.push_back(toPath(file));
  if (paths.empty()) throw py::value_error(fmt::format("{}, not an empty one", expected));
  return paths;
}

// A file of sums must not be lost because the result has its name.
void refuseInput(const std::vector<std::string>& inputs, const std::string& output) {
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (std::filesystem::equivalent(input, output, missing))
      throw py::value_error(fmt::format("output: {} is one of the files that are added", output));
  }
}

std::unique_ptr<PictureObject> objectOf(picture::MergedPicture& merged) {
  const picture::Sums& sums = merged.sums.done;
  const RTsumsInfo info = sums.info();
  auto made = std::make_unique<PictureObject>();
  made->picture = std::move(merged.picture);
  std::erase_if(made->picture.planes, [&](const auto& plane) {
    return !(plane.first & (merged.sums.facts.channels | RT_RGBA));
  });
  describePicture(made->stats, picture::statsOf(sums));
  made->stats.attr("pop")("transport_reason"); // sums do not hold it
  made->stats["seeds"] = info.seeds;
  made->stats["samples"] = uint64_t(info.samples) * info.seeds;
  return made;
}

py::object merge(const py::object& files, const py::object& output, bool withSums) {
  const std::vector<std::string> paths = pathsOf(files);
  const std::string path = output.is_none() ? "" : toPath(output);
  const picture::Format* const format = output.is_none() ? nullptr : &formatFor(path);
  if (withSums && (!format || format->encode != picture::encodeExr))
    throw py::value_error("sums: an output with the suffix .exr was expected");
  if (format) refuseInput(paths, path);
  picture::MergedPicture merged;
  std::string failure;
  {
    const ReleaseGil release;
    try {
      merged = picture::mergePictures(paths);
    } catch (const picture::InputError& error) { failure = error.what(); }
  }
  raiseOsError(failure);
  std::unique_ptr<PictureObject> made = objectOf(merged);
  if (!merged.warning.empty() && PyErr_WarnEx(PyExc_RuntimeWarning, merged.warning.c_str(), 1) != 0)
    throw py::error_already_set();
  if (format) {
    const ReleaseGil release;
    std::string bytes = format->encode(made->picture);
    if (withSums) picture::appendSums(bytes, merged.sums);
    try {
      picture::writeFile(path, bytes);
    } catch (const std::runtime_error& error) { failure = error.what(); }
  }
  raiseOsError(failure);
  return py::cast(std::move(made));
}

} // namespace

void defineMerge(py::module_& module) {
  module.def("merge", merge, py::arg("files"), py::arg("output") = py::none(), py::kw_only(),
             py::arg("sums") = false,
             "Adds pictures that differ in their seeds alone, as vv merge does, and returns their "
             "Picture. files: EXR files that vv --sums has written, and files of vv --resume. "
             "output: a file for the picture. sums: put the sums behind its pixels, so that it can "
             "be merged again. Raises OSError for a file that cannot be read, and RenderError if "
             "the files do not belong together.");
}
