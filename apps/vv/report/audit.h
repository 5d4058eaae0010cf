// audit.h: Compares pictures with a reference: the error of one picture (--compare), and the
// coverage of the error bars over many pictures (--audit). [one thread]
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libpicture/coverage.h"
#include "libpicture/missing_light.h"
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
  // renderer: that of the world, which does not change meanwhile.
  Audit(const Options& options, xvrml::World& world, picture::Renderer& renderer)
      : options_(options), world_(world), renderer_(renderer) {}
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
  // Renders the view without light samples, as often as the reference is worth pictures of the
  // series. Returns false if it was interrupted.
  bool hitEmitters(picture::View view, const picture::RenderResult& made);
  std::string whatIsWrong() const;
  const Options& options_;
  xvrml::World& world_;
  picture::Renderer& renderer_;
  std::function<void(const std::string&)> progress_;
  picture::Picture first_;
  picture::Coverage coverage_;
  std::vector<std::vector<float>> hits_; // pictures without light samples
  picture::MissingLight missing_;
  std::string reference_; // description of the reference in words
  double samples_ = 0;
};

} // namespace vv
