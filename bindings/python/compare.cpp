// compare.cpp: Implements compare(), which tells whether two pictures differ by more than their
// noise, as vv compare does. [GIL held]
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/compare/comparison.h"
#include "numbers.h"
#include "picture_object.h"

namespace {

// Returns the picture of an array of radiance.
picture::Picture pictureOf(const py::object& given, const std::string& name) {
  const py::array_t<float> image = imageArray(given, name, true);
  picture::Picture made;
  made.height = int(image.shape(0));
  made.width = int(image.shape(1));
  made.planes[RT_RGBA] = rgbaOfImage(image);
  return made;
}

bool isPath(const py::object& given) {
  return py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__");
}

// Returns a picture and its name for messages.
std::pair<picture::Picture, std::string> read(const py::object& given, const std::string& name) {
  if (py::isinstance<PictureObject>(given)) return {given.cast<PictureObject&>().picture, name};
  if (!isPath(given)) return {pictureOf(given, name), name};
  const std::string path = toPath(given);
  std::string failure;
  picture::Picture made;
  {
    const ReleaseGil release;
    try {
      made = picture::readForComparison(path);
    } catch (const picture::InputError& error) { failure = error.what(); }
  }
  raiseOsError(failure);
  return {std::move(made), path};
}

py::object compare(const py::object& a, const py::object& b,
                   const std::optional<std::array<int, 2>>& samples, bool variance) {
  if (samples && ((*samples)[0] < 1 || (*samples)[1] < 1))
    throw py::value_error("samples: two numbers of at least 1 expected");
  auto [first, firstName] = read(a, "a");
  auto [second, secondName] = read(b, "b");
  std::string json, failure;
  {
    const ReleaseGil release;
    try {
      json = picture::comparisonJson(picture::comparisonOf(
          {firstName, secondName}, {std::move(first), std::move(second)}, {samples, variance}));
    } catch (const picture::CompareError& error) { failure = error.what(); }
  }
  if (!failure.empty()) throw py::value_error(failure);
  return py::module_::import("json").attr("loads")(json);
}

} // namespace

void defineCompare(py::module_& module) {
  module.def(
      "compare", compare, py::arg("a"), py::arg("b"), py::kw_only(),
      py::arg("samples") = py::none(), py::arg("variance") = false,
      "Tells whether two pictures differ by more than their noise, as vv compare does, and "
      "returns what vv compare --json prints, as a dict: 'same' is the answer, 'changes' the "
      "places that differ. a, b: file names, Pictures, or radiance of shape (height, width, "
      "3). samples: their samples per pixel; the same number twice finds most. variance: "
      "judge single pixels by the channel variance. Raises OSError for a file that cannot "
      "be read, and ValueError if the pictures cannot be compared.");
}
