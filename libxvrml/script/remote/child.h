// child.h: a process of the program xvrml-script-host: where the program is, starting it at one end
// of a socket pair, its memory limit, its end. Everything of Linux that the browser's side needs is
// in child.cpp. Other children of the program that uses the library are left alone: only own
// processes are waited for. [the browser's thread]
#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

namespace xvrml {

// $XVRML_SCRIPT_HOST, or the program that is installed (or built) with the library; "" if it is not
// there, and why.
std::string findScriptHostProgram(std::string& why);

class Child {
 public:
  Child() = default;
  ~Child(); // ends it
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Starts the program; its end of the socket pair is file descriptor 3, all others but the
  // standard ones are closed, and these lead nowhere. It ends with this process. Returns the own
  // end, or -1 and why.
  int start(const std::string& program, std::string& why);
  void limitMemory(uint64_t bytes); // of address space
  void kill() noexcept;
  // How it ended, for people: "ended with code 1"; waits for that for a moment, then kills it.
  std::string ending();
  pid_t number() const { return pid_; }
  // Returns the processor time that it has used, in seconds; 0 if that is not known.
  double processorSeconds() const;
  // Returns true if it computes, or would if a processor were free; false if it waits or sleeps.
  bool computes() const;

 private:
  bool reap(int milliseconds) noexcept;
  pid_t pid_ = 0, owner_ = 0;
  int descriptor_ = -1; // names this process and no later one of the same number
  bool ended_ = false, known_ = false;
  int status_ = 0;
  long peak_ = 0; // kB
};

} // namespace xvrml
