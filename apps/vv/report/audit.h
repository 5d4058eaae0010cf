// audit.h: pictures compared with a reference: how far one is off (--compare), and whether the
// error bars of many hold (--audit). [one thread]
#pragma once

#include <functional>
#include <string>

#include "libpicture/coverage.h"
#include "libpicture/renderer.h"
#include "options/options.h"

namespace vv {

// What --compare prints. Throws Failure if the file cannot be read or is of another size.
std::string compareText(const picture::Picture& made, const std::string& path);

class Audit {
 public:
  Audit(const Options& options, picture::Renderer& renderer)
      : options_(options), renderer_(renderer) {}
  // Called before each picture with what it is, and with "" after the last.
  void setProgress(std::function<void(const std::string&)> progress) {
    progress_ = std::move(progress);
  }
  // false: interrupted.
  bool run(const picture::View& view);
  bool good() const;
  std::string text() const;
  // The first picture of the series.
  std::string encode(picture::Format format) const { return picture::encode(first_, format); }

 private:
  picture::RenderResult render(const picture::View& view, const std::string& what);
  std::string whatIsWrong() const;
  const Options& options_;
  picture::Renderer& renderer_;
  std::function<void(const std::string&)> progress_;
  picture::Picture first_;
  picture::Coverage coverage_;
  std::string reference_; // in words
  double samples_ = 0;
};

} // namespace vv
