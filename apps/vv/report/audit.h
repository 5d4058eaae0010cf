// audit.h: Compares pictures with a reference: the error of one picture (--compare), and the
// coverage of the error bars over many pictures (--audit). [one thread]
#pragma once

#include <functional>
#include <string>

#include "libpicture/coverage.h"
#include "libpicture/renderer.h"
#include "options/options.h"

namespace vv {

// Returns the text that --compare prints. Throws Failure if the file cannot be read or has another
// size.
std::string compareText(const picture::Picture& made, const std::string& path);

// Throws Failure if the picture of --compare cannot be read or has another size.
void checkReference(const Options& options);

class Audit {
 public:
  Audit(const Options& options, picture::Renderer& renderer)
      : options_(options), renderer_(renderer) {}
  // The callback gets a description before each picture, and "" after the last one.
  void setProgress(std::function<void(const std::string&)> progress) {
    progress_ = std::move(progress);
  }
  // Returns false if it was interrupted.
  bool run(const picture::View& view);
  bool good() const;
  std::string text() const;
  // Returns the first picture of the series.
  const picture::Picture& picture() const { return first_; }

 private:
  picture::RenderResult render(const picture::View& view, const std::string& what);
  std::string whatIsWrong() const;
  const Options& options_;
  picture::Renderer& renderer_;
  std::function<void(const std::string&)> progress_;
  picture::Picture first_;
  picture::Coverage coverage_;
  std::string reference_; // description of the reference in words
  double samples_ = 0;
};

} // namespace vv
