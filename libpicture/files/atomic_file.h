// atomic_file.h: Writes files atomically: the content goes to a temporary file in the same folder,
// which is then renamed. A file is either complete or absent. Several threads may write at a time;
// of those that write the same file, the last one wins. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace picture {

// disk: the bytes are on the disk before the file is replaced, so that a machine that loses its
// power has the old file or the new one.
enum class Wait : uint8_t { no, disk };

// Writes a file. The previous file stays until the new content is complete. A link stays, too: the
// file that it leads to is replaced or made. Devices and pipes are written directly. Throws
// std::runtime_error naming the file and the reason.
void writeFile(const std::string& path, std::string_view bytes, Wait wait = Wait::no);
// Writes the pieces one after the other, so that a large file need not be in memory as a whole.
void writeFile(const std::string& path, std::span<const std::string> pieces);

// Writes a file as writeFile() does, but no device and no pipe: opening or writing one may block
// for ever. It is for writes that a program or a script asks for while others wait.
void writeRegularFile(const std::string& path, std::string_view bytes, Wait wait = Wait::no);

// Does the same for a file that has been read and edited: protectFile() does not hinder it, and
// protects the new file instead of the old one. Waits until the bytes are on the disk.
void writeEditedFile(const std::string& path, std::string_view bytes);

// Returns why writeRegularFile() would refuse a path that is no regular file; empty if it is one,
// or does not exist.
std::string whyNotRegular(const std::string& path);

// Returns the file that a path leads to through symbolic links, whether it exists or not.
std::string followLinks(const std::string& path);

// Makes a new file with these rights, less those that the process withholds (umask), and opens it
// for writing. Nothing that has this name already is opened, also no link. Returns the descriptor;
// -1: errno says why, EEXIST for a name that is taken.
int openNew(const std::string& path, unsigned rights);

// Writes all bytes to an open descriptor; `name` is for the message. Throws std::runtime_error.
void writeDescriptor(int descriptor, std::string_view bytes, const std::string& name);

// Protects a regular file: writeFile() refuses to replace it, under any of its names. `what` is for
// the message, such as "the world that is read". Does nothing if the path is not a regular file.
void protectFile(const std::string& path, const std::string& what);

// Returns why writeFile(path) would fail, as far as this is known without writing; empty if no
// reason is known.
std::string whyNotWritable(const std::string& path);
// Returns the same of writeEditedFile(path).
std::string whyNotEditable(const std::string& path);

// Removes the temporary files of all writes in progress. A signal handler that ends the process may
// call it.
void removeTemporaries() noexcept;

} // namespace picture
