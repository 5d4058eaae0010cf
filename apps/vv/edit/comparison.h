// comparison.h: Keeps a still picture as A, shows it in the place of the present one, and finds the
// pixels whose light has changed since. Also judges changes of probes. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "edit/edit_model.h"
#include "libpicture/pixel_reading.h"

namespace vv {

// --- Changes of light ---

using Difference = picture::LightDifference;
// All changes that are judged together are significant at this level (common/holm.h).
inline constexpr double changeLevel = 0.05;

// The changes of the pixels of a picture.
struct ChangePicture {
  int width = 0, height = 0;
  // The change in cd/m2 of each pixel where it is significant, otherwise 0; first row at the top.
  std::vector<float> changes;
  size_t judged = 0, significant = 0; // pixels; those that are not trusted are not judged
  float most = 0, least = 0;          // the largest gain, and the largest loss (below 0)

  // Returns the change at a place of the picture, from -1 to 1 each way.
  float at(double x, double y) const;
};
// The pictures have picture::readingChannels, linear light and one size.
ChangePicture compare(const picture::Picture& before, const picture::Picture& now);
// Returns the bytes of the present picture, dimmed and without colours, with the changes in orange
// (gains) and blue (losses). rgb: the picture as it is shown.
std::vector<uint8_t> drawChanges(const ChangePicture& changes, const std::vector<uint8_t>& rgb);

// --- A, the picture that was kept ---

class Comparison {
 public:
  enum class Shown : uint8_t { present, a, wiper, difference };
  // A picture that covers the left part of the present one, from 0 to 1.
  struct Cover {
    int width = 0, height = 0; // 0: there is none
    std::vector<uint8_t> rgb;
    uint64_t number = 0; // grows when it is another one
  };
  // How a picture is shown on the screen.
  struct Look {
    picture::ViewTransform transform;
    double scaleEnd = 0; // as in LivePicture
    bool operator==(const Look&) const = default;
  };

  // Keeps the next still picture as A, unless the world is edited or the view changes before.
  // changes: Editor::changes().
  void ask(uint64_t changes, const EditView& view);
  bool hasA() const { return a_.width > 0; }
  bool isComplete() const { return isComplete_; } // A has all its samples
  // Returns A; null: there is none.
  const picture::Picture* a() const { return hasA() ? &a_ : nullptr; }
  // Returns why a picture of this view and size cannot be compared with A; "": it can be.
  std::string whyNot(const EditView& view, int width, int height) const;
  // Shows something, or if it is shown, the present picture again. Throws xvrml::EditError without
  // A.
  void toggle(Shown what);
  Shown shown() const { return shown_; }
  // Tells whether A is the picture of this frame, so that it gets better with it.
  bool isRefined(uint64_t frame) const { return frame_ != 0 && frame == frame_; }
  // Tells whether it waits for a still picture.
  bool wantsPicture() const;
  // Takes a still picture with picture::readingChannels and only unbiased samples. frame: its
  // number. isFinished: it has all its samples. Returns whether A is this picture: A is refined as
  // long as its frame is.
  bool take(const picture::Picture& picture, uint64_t frame, uint64_t changes, const EditView& view,
            bool isFinished);
  // Follows the window: A is not shown any more if it has another view or size. isOutdated: the
  // last still picture does not show the world as it is.
  void follow(const EditView& view, int width, int height, const Look& look, bool isOutdated);
  void clear();

  const Cover& cover() const { return cover_; }
  double coverPart() const { return shown_ == Shown::wiper ? (1 + wiper_) / 2 : 1; }
  // The place of the line between A at its left and the present picture, from -1 to 1.
  double wiper() const { return wiper_; }
  void setWiper(double x);
  // The changes that are shown; null: they wait for a still picture.
  const ChangePicture* changes() const { return changes_ ? &*changes_ : nullptr; }
  // Returns, once, what is to be said to the user.
  std::string takeMessage() { return std::exchange(message_, {}); }

 private:
  void setCover(int width, int height, std::vector<uint8_t> rgb);
  void coverWithA();

  struct Asked {
    uint64_t changes;
    EditView view;
  };
  std::optional<Asked> asked_;
  picture::Picture a_;
  EditView view_;      // the view of A
  uint64_t frame_ = 0; // the number of A's frame
  bool isComplete_ = false;
  Shown shown_ = Shown::present;
  double wiper_ = 0;
  Look look_;
  std::optional<ChangePicture> changes_;
  Cover cover_;
  std::string message_;
};

} // namespace vv
