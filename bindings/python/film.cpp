// film.cpp: Implements the Python class Film, which writes pictures or arrays to a film file. [GIL
// held; released while encoding]
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "gil.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/film.h"
#include "objects.h"
#include "picture_object.h"

namespace {

class FilmObject {
 public:
  FilmObject(const py::object& file, double fps)
      : path_(toPath(file)), kind_(picture::filmOf(path_)), fps_(fps) {
    if (kind_ == picture::FilmKind::none)
      throw py::value_error(fmt::format("a file name with one of the suffixes {} expected, not {}",
                                        picture::filmSuffixes, path_));
    if (!(fps > 0 && fps < 1e6)) throw py::value_error("fps: above 0 expected");
    raiseOsError(picture::whyNotWritable(path_));
    if (const std::string why = picture::whyNoFilm(kind_); !why.empty())
      throw std::runtime_error(path_ + ": " + why);
  }

  void add(const py::object& shown) {
    if (closed_) throw py::value_error("the film is closed");
    if (py::isinstance<PictureObject>(shown)) {
      const picture::Picture& made = shown.cast<const PictureObject&>().picture;
      std::vector<uint8_t> bytes;
      {
        ReleaseGil release;
        bytes = picture::displayBytes(made);
      }
      return append(bytes.data(), made.width, made.height, made.note);
    }
    const auto array = py::array::ensure(shown);
    if (!array || array.ndim() != 3 || array.shape(2) != 3 ||
        !py::isinstance<py::array_t<uint8_t>>(array))
      throw py::type_error("a Picture or an array of uint8 of shape (height, width, 3) expected");
    const auto rows =
        py::array_t<uint8_t, py::array::c_style | py::array::forcecast>::ensure(array);
    append(rows.data(), int(array.shape(1)), int(array.shape(0)));
  }

  void close() {
    if (closed_) return;
    closed_ = true;
    if (!film_) return;
    std::string failure;
    {
      ReleaseGil release;
      const std::string bytes = film_->finish();
      film_.reset();
      try {
        picture::writeFile(path_, bytes);
      } catch (const std::runtime_error& error) { failure = error.what(); }
    }
    raiseOsError(failure);
  }

  // Writes nothing if the with block ended with an exception.
  void exit(const py::object& type, const py::object&, const py::object&) {
    if (type.is_none()) return close();
    closed_ = true;
    film_.reset();
  }

  const std::string& path() const { return path_; }

 private:
  // note: what the file says about its pictures. It stands at the beginning of the file.
  void append(const uint8_t* rgb, int width, int height, const std::string& note = "") {
    if (film_ && (width != width_ || height != height_))
      throw py::value_error(fmt::format("all pictures of a film have one size: {}x{}, not {}x{}",
                                        width_, height_, width, height));
    if (film_ && note != note_)
      throw py::value_error("the pictures of a film are denoised by one library, or none of them "
                            "is denoised");
    ReleaseGil release;
    if (!film_) film_ = std::make_unique<picture::Film>(kind_, width, height, fps_, note);
    note_ = note;
    width_ = width;
    height_ = height;
    film_->add({rgb, size_t(width) * size_t(height) * 3});
  }

  std::string path_;
  picture::FilmKind kind_;
  double fps_;
  int width_ = 0, height_ = 0;
  std::string note_;
  bool closed_ = false;
  std::unique_ptr<picture::Film> film_; // null before the first picture and after the last one
};

} // namespace

void defineFilm(py::module_& module) {
  py::class_<FilmObject>(module, "Film",
                         "A film file: Film('turn.mp4', fps=25), then add() for each picture, then "
                         "close(). It is also a context manager. The suffix (mp4, webm, gif) "
                         "selects the format. close() writes the file.")
      .def(py::init<const py::object&, double>(), py::arg("path"), py::arg("fps") = 25.0)
      .def("add", &FilmObject::add, py::arg("picture"),
           "Appends a Picture, or an array of uint8 of shape (height, width, 3). All must have the "
           "same size.")
      .def("close", &FilmObject::close, "Writes the file, if the film has a picture.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", &FilmObject::exit)
      .def("__repr__", [](const FilmObject& self) { return toText("<Film " + self.path() + ">"); });
}
