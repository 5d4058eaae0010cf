// atomic_file.h: output that is whole or not there: written beside its name, then renamed. [one
// thread at a time]
#pragma once

#include <string>
#include <string_view>

namespace picture {

// Writes a file; what was there before stays until the new content is complete. Devices and pipes
// are written to directly. Throws std::runtime_error naming the file and the reason.
void writeFile(const std::string& path, std::string_view bytes);

// Writes everything to an open descriptor; `name` for the message. Throws std::runtime_error.
void writeDescriptor(int descriptor, std::string_view bytes, const std::string& name);

// Keeps a regular file from being replaced: writeFile() refuses it under every name that it has.
// what: "the world that is read", for the message. Anything else, or nothing, at this path is
// passed over.
void keepFile(const std::string& path, const std::string& what);

// Why writeFile(path) cannot succeed, as far as can be told without writing; empty if nothing
// speaks against it.
std::string whyNotWritable(const std::string& path);

// Removes the file that a write in progress would have renamed. May be called from a signal handler
// that ends the process.
void removeTemporary() noexcept;

} // namespace picture
