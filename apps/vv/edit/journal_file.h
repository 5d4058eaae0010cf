// journal_file.h: A file beside a world's file that keeps its text with edits that are not saved.
// A program that uses one has locked it; the lock ends with the program, however that ends. Several
// programs that edit the same file have one each. [any thread, one at a time]
#pragma once

#include <cstdint>
#include <ctime>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace vv {

// Tells a text from others.
struct TextStamp {
  uint64_t bytes = 0, hash = 0; // both 0: that of no text
  bool operator==(const TextStamp&) const = default;
};
TextStamp stampOf(std::string_view text);

struct JournalContent {
  TextStamp base; // the text of the world's file that was edited
  std::string text;
};

class JournalFile {
 public:
  // Returns a new, empty one for a world's file. Throws std::runtime_error, which names the file
  // and the reason, if none can be made.
  static JournalFile make(const std::string& world);
  // Opens one that no running program uses, and reads it. Throws std::runtime_error, which says why
  // it cannot be used. isBusy: is set if that is because a running program uses it; may be null.
  static JournalFile open(const std::string& path, JournalContent& content, bool* isBusy = nullptr);

  JournalFile(JournalFile&& other) noexcept
      : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  JournalFile& operator=(JournalFile&& other) noexcept;
  ~JournalFile(); // the file stays

  const std::string& path() const { return path_; }
  // Returns whether it still has its path: somebody may have removed it.
  bool isInPlace() const;
  // Replaces the content atomically, and returns when it is on the disk. Throws std::runtime_error.
  void write(const TextStamp& base, std::string_view text);
  // Removes the file, and unlocks it.
  void remove();

 private:
  JournalFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::string path_;
  int descriptor_ = -1; // the open file, which is locked; -1: there is none any more
};

// A journal that stands beside a world's file.
struct FoundJournal {
  std::string path;
  std::time_t written = 0; // when, in seconds since 1970
};
// Returns the journal of a world's file that was written last and can be used with its text, which
// is only read if there are journals. The path is empty if there is none. refused: is set to a
// message about one that is there and cannot be used. A journal that says what the file says is
// removed, and so is an empty one, with a message. The heads of all are read, and the text of the
// one that is returned.
FoundJournal findJournal(const std::string& world, const std::function<std::string()>& readText,
                         std::string& refused);
// Tells whether a path is that of a journal of a world's file, whether there is one or not.
bool isJournalOf(const std::string& world, const std::string& path);
// Tells quickly whether a world's file has a journal, by its name alone. Returns its path, or "".
std::string journalBeside(const std::string& world);

} // namespace vv
