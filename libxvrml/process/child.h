// child.h: a process that works for the library: finds its program, starts it at one end of a
// socket pair, limits its memory and ends it. It waits for its own processes only and leaves other
// children of the application alone. [one thread at a time]
#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

namespace xvrml {

// A program that the library starts, and the environment variable that may name another file.
struct HelperProgram {
  const char *name, *variable;
};
inline constexpr HelperProgram scriptHostProgram = {"xvrml-script-host", "XVRML_SCRIPT_HOST"};
inline constexpr HelperProgram decoderProgram = {"xvrml-decoder", "XVRML_DECODER"};
inline constexpr HelperProgram stepReaderProgram = {"xvrml-step-reader", "XVRML_STEP_READER"};

// Returns the file that the variable names, or the program installed (or built) with the library.
// Returns "", with the reason, if there is none.
std::string findHelper(const HelperProgram& helper, std::string& why);

class Child {
 public:
  Child() = default;
  ~Child(); // kills the process
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Starts the program. Its end of the socket pair is file descriptor 3. Standard input, output and
  // error are /dev/null; all other descriptors are closed. The program ends with this process.
  // Returns the browser's end, or -1 with the reason.
  int start(const std::string& program, std::string& why);
  void limitMemory(uint64_t bytes); // limits the address space
  void kill() noexcept;
  // Returns how the process ended, for messages: "ended with code 1". It waits briefly for the end,
  // then kills the process.
  std::string ending();
  pid_t number() const { return pid_; }
  // Returns the processor time used, in seconds; 0 if unknown.
  double processorSeconds() const;
  // Returns true if it computes, or would if a processor were free; false if it waits or sleeps.
  bool computes() const;

 private:
  bool reap(int milliseconds) noexcept;
  pid_t pid_ = 0, owner_ = 0;
  int descriptor_ = -1; // pidfd: refers to this process even if its number is reused
  bool ended_ = false, known_ = false;
  int status_ = 0;
  long peak_ = 0; // largest memory use in kB
};

} // namespace xvrml
