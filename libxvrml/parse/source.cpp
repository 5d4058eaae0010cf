// source.cpp: reads, maps and unpacks files, and finds out what they are.
#include "parse/source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/lexer.h"
#include "parse/encodings.h"
#include "parse/other_formats.h"
#include "parse/suffix.h"
#include "parse/utf16.h"
#include "system/files.h"
#include "xvrml/comments.h"

namespace xvrml {
namespace {

[[noreturn]] void refuse(const std::string& name, std::string message, uint32_t line = 0) {
  throw LoadError{{Severity::error, name, line, line, std::move(message), {}, 0}};
}

// Returns "VRML97, X3D ClassicVRML, ... and glTF".
std::string readableFormats() {
  std::string text;
  for (int i = 0; i < encodingCount(); ++i)
    text += fmt::format("{}{}",
                        i == 0                    ? ""
                        : i + 1 < encodingCount() ? ", "
                                                  : " and ",
                        encodingName(static_cast<Encoding>(i)));
  return text;
}

// Refuses a file of a known format that cannot be read.
[[noreturn]] void refuseOther(const std::string& name, std::string_view bytes) {
  const OtherFormat& format = *otherFormat(bytes);
  refuse(name, fmt::format("this file is {}, which cannot be read ({} can): {}", format.name,
                           readableFormats(), format.remedy));
}

struct Descriptor {
  int number = -1;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

void readAll(int descriptor, const std::string& name, const Limits& limits, TextBuffer& bytes) {
  for (;;) {
    const size_t had = bytes.text().size();
    constexpr size_t step = 1 << 20;
    char* const room = bytes.grow(step);
    if (!room) refuse(name, "its text " + bytes.overLimitText());
    const ssize_t got = ::read(descriptor, room, step);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(name, fmt::format("this file cannot be read: {}", std::strerror(errno)));
    bytes.keep(had + static_cast<size_t>(got));
    if (bytes.text().size() > limits.fileBytes)
      refuse(name, fmt::format("this file is longer than limit fileBytes={}", limits.fileBytes));
    if (got == 0) return bytes.fit();
  }
}

// Inflates all gzip members. Damaged data is refused only if nothing came out; a truncated file
// shows what it has.
void inflateAll(std::string_view packed, const std::string& name, const Limits& limits,
                std::string& damage, TextBuffer& out) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) refuse(name, "no memory to unpack it");
  struct End {
    z_stream* stream;
    ~End() { inflateEnd(stream); }
  } end{&stream};
  constexpr uint64_t freeBytes = 1 << 20; // files up to this size may have any compression ratio
  const uint64_t byRatio = std::max<uint64_t>(freeBytes, limits.inflateRatio * packed.size());
  const uint64_t most = std::min({limits.inflateBytes, limits.fileBytes, byRatio});
  size_t used = 0;
  int status = Z_OK;
  while (status != Z_STREAM_END || used < packed.size()) {
    if (status == Z_STREAM_END) { // another member follows, or padding
      if (packed.size() - used < 2 || packed.substr(used, 2) != "\x1f\x8b" ||
          inflateReset(&stream) != Z_OK)
        break;
    }
    const size_t had = out.text().size();
    const size_t step = std::min<size_t>(std::max<size_t>(1 << 16, had / 4), 64 << 20);
    char* const room = out.grow(step);
    if (!room) refuse(name, "its unpacked text " + out.overLimitText());
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
    stream.avail_in = static_cast<uInt>(std::min<size_t>(packed.size() - used, 1u << 30));
    const uInt offered = stream.avail_in;
    stream.next_out = reinterpret_cast<Bytef*>(room);
    stream.avail_out = static_cast<uInt>(step);
    status = inflate(&stream, Z_NO_FLUSH);
    used += offered - stream.avail_in;
    out.keep(had + step - stream.avail_out);
    if (out.text().size() > most) {
      const char* limit = most == limits.inflateBytes ? "inflateBytes"
                          : most == limits.fileBytes  ? "fileBytes"
                                                      : "inflateRatio";
      const uint64_t value = most == limits.inflateBytes ? limits.inflateBytes
                             : most == limits.fileBytes  ? limits.fileBytes
                                                         : limits.inflateRatio;
      refuse(name, fmt::format("this file unpacks to more than limit {}={} allows", limit, value));
    }
    if (status != Z_OK && status != Z_STREAM_END) {
      damage = status == Z_BUF_ERROR
                   ? "the gzip data ends early"
                   : fmt::format("damaged gzip data: {}", stream.msg ? stream.msg : "unknown");
      if (out.text().empty()) refuse(name, damage);
      break;
    }
  }
  out.fit();
}

bool isGzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string_view firstLine(std::string_view text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

// Returns whether a text without a header looks like VRML97: it begins with a node or the keyword
// of a statement.
bool looksLikeVrml(std::string_view text) {
  Diagnostics none;
  none.limit = 0;
  Locator locator(text, nullptr, none);
  Lexer lexer(locator);
  const Token first = lexer.next();
  if (!first.is(TokenKind::identifier)) return false;
  if (first.text == "PROFILE" || first.text == "DEF" || first.text == "PROTO" ||
      first.text == "EXTERNPROTO")
    return lexer.peek().is(TokenKind::identifier);
  return lexer.peek().is(TokenKind::braceOpen);
}

} // namespace

std::string_view withoutDosEnd(std::string_view text) {
  using namespace std::string_view_literals;
  if (text.substr(0, 4).find('\0') != text.npos) return text;      // in UTF-16
  const size_t end = text.find_last_not_of(" \t\r\n\x1a\0"sv) + 1; // 0 if there is nothing else
  const size_t mark = text.find_first_of("\x1a\0"sv, end);
  return mark == text.npos ? text : text.substr(0, mark);
}

char* TextBuffer::grow(size_t more) {
  if (const size_t wanted = size_ + more; wanted > share_.bytes()) {
    const uint64_t extra = wanted - share_.bytes();
    if (!share_.take(extra)) return nullptr;
    char* const bytes = static_cast<char*>(std::realloc(bytes_.get(), wanted));
    if (!bytes) {
      share_.give(extra);
      throw std::bad_alloc();
    }
    static_cast<void>(bytes_.release()); // realloc() has freed it
    bytes_.reset(bytes);
  }
  return bytes_.get() + size_;
}

void TextBuffer::fit() {
  if (size_ == 0 || size_ == share_.bytes()) return;
  char* const bytes = static_cast<char*>(std::realloc(bytes_.get(), size_));
  if (!bytes) return;
  static_cast<void>(bytes_.release());
  bytes_.reset(bytes);
  share_.give(share_.bytes() - size_);
}

std::string TextBuffer::overLimitText() const {
  return "takes, together with the rest of the world, more than " +
         (share_.budget() ? share_.budget()->name() : std::string());
}

static FileStamp stampOf(const struct stat& status) {
  const timespec time = os::modifiedTime(status);
  return {int64_t(time.tv_sec), int64_t(time.tv_nsec), int64_t(status.st_size),
          uint64_t(status.st_ino)};
}

FileStamp stampOf(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? stampOf(status) : FileStamp();
}

Source Source::open(const std::string& path, const Limits& limits, const BudgetPtr& budget) {
  Source source(budget);
  if (path == "-") {
    readAll(STDIN_FILENO, "-", limits, source.buffer_);
    source.text_ = source.buffer_.text();
  } else {
    Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.number < 0)
      refuse(path, fmt::format("this file cannot be opened: {}", std::strerror(errno)));
    struct stat status {};
    if (fstat(file.number, &status) != 0)
      refuse(path, fmt::format("this file cannot be read: {}", std::strerror(errno)));
    if (S_ISDIR(status.st_mode)) refuse(path, "this is a folder, not a world");
    if (!S_ISREG(status.st_mode)) refuse(path, "this is not a regular file");
    source.stamp_ = stampOf(status);
    const auto size = static_cast<uint64_t>(status.st_size);
    if (size > limits.fileBytes)
      refuse(path, fmt::format("this file has {} bytes: more than limit fileBytes={}", size,
                               limits.fileBytes));
    if (size > 0) {
      void* mapping = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
      if (mapping != MAP_FAILED) {
        source.mapping_ = mapping;
        source.mappedBytes_ = size;
        madvise(mapping, size, MADV_SEQUENTIAL);
        source.text_ = {static_cast<const char*>(mapping), size};
      } else {
        readAll(file.number, path, limits, source.buffer_);
        source.text_ = source.buffer_.text();
      }
    }
  }
  source.unpack(path, limits, budget);
  return source;
}

Source Source::fromMemory(std::string_view bytes, const std::string& name, const Limits& limits,
                          const BudgetPtr& budget) {
  if (bytes.size() > limits.fileBytes)
    refuse(name, fmt::format("this file has {} bytes: more than limit fileBytes={}", bytes.size(),
                             limits.fileBytes));
  Source source(budget);
  source.text_ = bytes;
  source.unpack(name, limits, budget);
  return source;
}

void Source::unpack(const std::string& name, const Limits& limits, const BudgetPtr& budget) {
  if ((packed_ = isGzip(text_))) {
    TextBuffer unpacked(budget);
    inflateAll(text_, name, limits, damage_, unpacked);
    buffer_ = std::move(unpacked); // the packed data is not needed any more
    text_ = buffer_.text();
  }
  if ((byteOrderMark_ = text_.starts_with("\xef\xbb\xbf"))) text_.remove_prefix(3);
  if ((utf16_ = isUtf16Vrml(text_))) {
    TextBuffer converted(budget);
    if (!convertUtf16(text_, converted))
      refuse(name, "its text in UTF-8 " + converted.overLimitText());
    buffer_ = std::move(converted);
    text_ = buffer_.text();
  }
}

Source::Source(Source&& other) noexcept
    : text_(other.text_), buffer_(std::move(other.buffer_)), damage_(std::move(other.damage_)),
      mapping_(std::exchange(other.mapping_, nullptr)), mappedBytes_(other.mappedBytes_),
      stamp_(other.stamp_), packed_(other.packed_), byteOrderMark_(other.byteOrderMark_),
      utf16_(other.utf16_) {}

Source::~Source() {
  if (mapping_) munmap(mapping_, mappedBytes_);
}

namespace {

// Reads a line that begins with "#X3D": "#X3D V3.3 utf8 [optional comment]" (ISO/IEC 19776-2
// 4.3.2.2). `complaint` becomes what is wrong with it, or stays empty.
FileVersion x3dVersion(std::string_view line, std::string& complaint) {
  FileVersion version{Encoding::x3dClassic, 3, 0};
  const std::string_view numbers = line.substr(std::min<size_t>(line.size(), 6));
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  if (!line.starts_with("#X3D V") || numbers.size() < 3 || !isDigit(numbers[0]) ||
      numbers[1] != '.' || !isDigit(numbers[2])) {
    complaint = "the header does not name a version as in '#X3D V3.3 utf8'; read as X3D 3.0";
    return version;
  }
  version.major = numbers[0] - '0';
  version.minor = numbers[2] - '0';
  if (!numbers.substr(3).starts_with(" utf8"))
    complaint = "the header does not say utf8 after X3D's version; read as UTF-8";
  if (version.major < 3 || version.major > 4) {
    complaint = fmt::format("X3D {}.{} is not known; read as X3D {}", version.major, version.minor,
                            version.major < 3 ? "3.0" : "4.0");
    version.minor = 0;
    version.major = version.major < 3 ? 3 : 4;
  }
  return version;
}

bool namesX3dClassic(std::string_view file) {
  return endsWithOneOf(file, {".x3dv", ".x3dvz", ".x3dv.gz"});
}

} // namespace

void Source::identify(const std::shared_ptr<const std::string>& file,
                      Diagnostics& diagnostics) const {
  setFileVersion(file, version(file, diagnostics));
}

// "#VRML V2.0 utf8 [optional comment] <line terminator>"
FileVersion Source::version(const std::shared_ptr<const std::string>& file,
                            Diagnostics& diagnostics) const {
  constexpr std::string_view exact = "#VRML V2.0 utf8";
  const auto ends = [](std::string_view rest) {
    return rest.empty() || rest[0] == ' ' || rest[0] == '\t' || rest[0] == '\n' || rest[0] == '\r';
  };
  if (!damage_.empty()) diagnostics.warn({file, 0, 0}, damage_);
  const EncodingInfo* found = text_.starts_with(exact) ? nullptr : recogniseEncoding(text_, *file);
  if (found && found->readMesh) return found->version();
  const auto warn = [&](std::string message) {
    diagnostics.warn({file, 1, 1}, std::move(message));
  };
  if (utf16_) warn("this file is in UTF-16; it was read, but its standard asks for UTF-8");
  // XML says that it may begin with a byte-order mark. The version stands in the X3D element.
  if (found) return found->version();
  if (byteOrderMark_)
    warn("the file begins with a byte-order mark, which a VRML97 header does not have; ignored");
  if (text_.starts_with(exact) && ends(text_.substr(exact.size()))) return {};
  // Search the first lines with content: blank lines and other comments may precede the header.
  std::string_view rest = text_;
  for (int line = 1; line <= 10 && !rest.empty(); ++line) {
    const std::string_view current = firstLine(rest);
    const bool comment = current.starts_with('#');
    if (comment && current.find("VRML") != current.npos) {
      if (current.find("V1.0") != current.npos) {
        if (!current.starts_with("#VRML V1.0 ascii"))
          warn("the file does not begin with exactly '#VRML V1.0 ascii'; read as VRML 1.0 anyway");
        return {Encoding::vrml1, 1, 0};
      }
      if (current.find("2.0") != current.npos) {
        warn(
            fmt::format("the file does not begin with exactly '{}'; read as VRML97 anyway", exact));
        return {};
      }
      refuse(*file,
             fmt::format("this file is not VRML97: expected '{}', found '{}'", exact,
                         current.substr(0, 60)),
             1);
    }
    if (comment && current.starts_with("#X3D")) {
      std::string complaint;
      const FileVersion found = x3dVersion(current, complaint);
      if (!complaint.empty()) warn(complaint);
      return found;
    }
    if (comment && current.starts_with("#Inventor")) {
      if (current.find("ascii") == current.npos) refuseOther(*file, rest);
      warn("Open Inventor is read as VRML 1.0: nodes and fields that VRML 1.0 lacks are left out");
      return {Encoding::vrml1, 1, 0};
    }
    if (!comment && current.find_first_not_of(" \t,") != current.npos) break;
    rest.remove_prefix(std::min(rest.size(), current.size() + 1));
  }
  if (otherFormat(text_)) refuseOther(*file, text_);
  if (looksLikeVrml(text_)) {
    const bool x3d = namesX3dClassic(*file) || text_.starts_with("PROFILE");
    warn(x3d ? "the header '#X3D V3.3 utf8' is missing; read as X3D 3.3 anyway"
             : fmt::format("the header '{}' is missing; read as VRML97 anyway", exact));
    return x3d ? FileVersion{Encoding::x3dClassic, 3, 3} : FileVersion();
  }
  if (const EncodingInfo* mesh = meshNamedBy(*file)) return mesh->version();
  if (text_.empty()) refuse(*file, fmt::format("this file is empty: expected '{}'", exact));
  refuse(
      *file,
      fmt::format("this file is not a VRML97 world: expected it to begin with '{}'. Formats that "
                  "can be read are {}",
                  exact, readableFormats()),
      1);
}

namespace {

// The deleter of a file's name. It stores the file's comments, depth, version and unit of lengths,
// so that they live as long as the name, which all nodes of the file share.
struct NameDeleter {
  std::string comments;
  uint64_t depth = 0;
  FileVersion version{};
  double metres = 1;
  FileStamp stamp{};
  GlobeOriginPtr origin = nullptr;
  void operator()(const std::string* name) const { delete name; }
};

} // namespace

std::shared_ptr<const std::string> fileName(const std::string& name, uint64_t depth) {
  return {new std::string(name), NameDeleter{{}, depth, {}, 1}};
}

uint64_t fileDepth(const std::shared_ptr<const std::string>& file) {
  const NameDeleter* known = std::get_deleter<NameDeleter>(file);
  return known ? known->depth : 0;
}

FileVersion fileVersion(const std::shared_ptr<const std::string>& file) {
  const NameDeleter* known = std::get_deleter<NameDeleter>(file);
  return known ? known->version : FileVersion();
}

void setFileVersion(const std::shared_ptr<const std::string>& file, const FileVersion& version) {
  if (NameDeleter* known = std::get_deleter<NameDeleter>(file)) known->version = version;
}

double lengthUnit(const std::shared_ptr<const std::string>& file) {
  const NameDeleter* known = std::get_deleter<NameDeleter>(file);
  return known ? known->metres : 1;
}

void setLengthUnit(const std::shared_ptr<const std::string>& file, double metres) {
  if (NameDeleter* known = std::get_deleter<NameDeleter>(file)) known->metres = metres;
}

GlobeOriginPtr globeOrigin(const std::shared_ptr<const std::string>& file) {
  const NameDeleter* known = std::get_deleter<NameDeleter>(file);
  return known ? known->origin : nullptr;
}

void setGlobeOrigin(const std::shared_ptr<const std::string>& file, GlobeOriginPtr origin) {
  if (NameDeleter* known = std::get_deleter<NameDeleter>(file)) known->origin = std::move(origin);
}

const GlobeOrigin* globeOriginOf(const Node& node) { return globeOrigin(node.source.file).get(); }

FileStamp fileStamp(const std::shared_ptr<const std::string>& file) {
  const NameDeleter* known = std::get_deleter<NameDeleter>(file);
  return known ? known->stamp : FileStamp();
}

FileVersion versionOf(const Node& node) { return fileVersion(node.source.file); }

namespace {

constexpr size_t mostComments = 4096; // bytes of comments that are kept

// Returns the comments of an XML file before its first element, each with an end of line.
std::string xmlComments(std::string_view rest) {
  std::string comments;
  while (comments.size() < mostComments) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    const bool comment = rest.starts_with("<!--");
    if (!comment && !rest.starts_with("<?")) break;
    const size_t end = rest.find(comment ? "-->" : "?>", 2);
    if (end == rest.npos || (comment && end < 4)) break;
    if (comment) comments += std::string(rest.substr(4, std::min(end - 4, mostComments))) + "\n";
    rest.remove_prefix(end + (comment ? 3 : 2));
  }
  return comments;
}

} // namespace

std::shared_ptr<const std::string> Source::nameWithComments(const std::string& name,
                                                            uint64_t depth) const {
  constexpr size_t most = mostComments;
  std::string comments = xmlComments(text_);
  std::string_view rest = text_;
  while (!rest.empty() && comments.size() < most) {
    const std::string_view line = firstLine(rest);
    const size_t begin = line.find_first_not_of(" \t\r,");
    if (begin != line.npos && line[begin] != '#') break;
    if (begin != line.npos)
      comments += std::string(line.substr(begin + 1, most - comments.size())) + "\n";
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  }
  return {new std::string(name), NameDeleter{std::move(comments), depth, {}, 1, stamp_}};
}

void setOpeningComments(const std::shared_ptr<const std::string>& file, std::string comments) {
  NameDeleter* const known = std::get_deleter<NameDeleter>(file);
  if (!known) return;
  comments.resize(std::min(comments.size(), mostComments));
  known->comments = std::move(comments);
}

std::string_view openingComments(const World& world) {
  for (const NodeRef& root : world.scope.roots)
    if (const NameDeleter* known =
            root ? std::get_deleter<NameDeleter>(root->source.file) : nullptr)
      return known->comments;
  return {};
}

} // namespace xvrml
