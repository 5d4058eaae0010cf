// journal.h: Keeps edits that are not saved in a file beside the world's file, so that they outlive
// a program that is killed, and finds those that an earlier program has left. Owned by a
// WorldEditor. [the browser's thread; files are written on a thread of their own]
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "edit/journal_file.h"
#include "xvrml/edit.h"

namespace vv {

// Edits that an earlier program has left, taken over.
struct LeftEdits {
  JournalContent content;
  JournalFile file;
};

class Journal {
 public:
  // Both must outlive the journal.
  Journal(xvrml::Editor& editor, xvrml::Browser& browser);
  ~Journal(); // the file stays if edits are not saved
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Writes the edits if it is time to, and removes the file when all are saved. Does not wait for
  // the disk. seconds: time of any clock. The world may be read meanwhile. Never throws.
  void advance(double seconds);
  // Removes the file if no edits are unsaved, or because they are thrown away.
  void settle();
  void throwAway();
  // Writes the edits as they are now, and waits for the disk. Returns the file; "": there are no
  // edits to be kept, or failure() says why they are not.
  std::string keep();
  const std::string& failure() const { return failure_; }
  // Returns, once, what is to be said to the user.
  std::string takeMessage() { return std::exchange(message_, {}); }

  // --- What an earlier program has left ---
  // Looks for it, unless it has been adopted, and says what is found by takeMessage().
  void look();
  const std::optional<FoundJournal>& left() const { return left_; }
  // Takes it, for a world that is loaded from its text. Throws xvrml::EditError.
  std::shared_ptr<LeftEdits> take();
  // Removes it. Throws xvrml::EditError.
  void throwLeftAway();
  // Says that the world was loaded from the text of these edits. To be called before any edit.
  // Throws xvrml::EditError.
  void adopt(LeftEdits& edits);

 private:
  void begin();
  void finish();
  void fail(const std::string& why);
  void noticeOtherWorld();

  xvrml::Editor& editor_;
  xvrml::Browser& browser_;
  const std::string world_;   // the path of the world's file
  const uint64_t generation_; // the browser's, whose world is edited
  bool isReplaced_ = false;   // another world has taken its place
  std::optional<JournalFile> file_;
  std::optional<TextStamp> base_; // the text of the world's file, once it is known
  uint64_t written_ = 0;          // Editor::changes() when the edits were written, or thrown away
  double next_ = 0;               // when they may be written again
  std::future<std::string> writing_; // why it failed; "": it is done
  std::string failure_, message_;
  std::optional<FoundJournal> left_;
};

} // namespace vv
