// xvrml_volume.cpp: Tests volumes from bytes made here: NRRD in every encoding, DDS, lists of
// numbers and stacks of pictures, and what must be refused.
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "image/volume.h"

using namespace xvrml;

namespace {

using Bytes = std::vector<uint8_t>;

Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

ImageRoom room(const Limits& limits) { return ImageRoom{limits}; }

Volume decode(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  Limits limits;
  limits.imagePixels = imagePixels;
  return decodeVolume(bytes, room(limits));
}
std::string whyNot(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  try {
    decode(bytes, imagePixels);
  } catch (const std::runtime_error& error) { return error.what(); }
  return "";
}
void expectRefused(const Bytes& bytes, const std::string& reason) {
  const std::string why = whyNot(bytes);
  EXPECT_NE(why.find(reason), why.npos) << "\"" << why << "\" lacks \"" << reason << '"';
}

std::string header(const std::string& type, const std::string& sizes, const std::string& encoding,
                   const std::string& more = "") {
  return "NRRD0004\n# comment\ntype: " + type + "\ndimension: 3\nsizes: " + sizes +
         "\nencoding: " + encoding + "\n" + more + "key:=value\n\n";
}
Bytes nrrd(const std::string& head, const Bytes& data) {
  Bytes bytes = bytesOf(head);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}
Bytes packed(const Bytes& data) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  Bytes out(data.size() + 100);
  stream.next_in = const_cast<uint8_t*>(data.data());
  stream.avail_in = uInt(data.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST(Volume, NrrdOfBytesIsKeptAsItIs) {
  const Bytes data = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const Bytes& file :
       {nrrd(header("uchar", "2 3 2", "raw"), data),
        nrrd(header("unsigned char", "2 3 2", "gzip"), packed(data)),
        bytesOf(header("uint8", "2 3 2", "ascii") + "1 2 3 4\n5 6, 7\t8\n9 10 11\n12\n")}) {
    const Volume v = decode(file);
    EXPECT_EQ(v.width, 2);
    EXPECT_EQ(v.height, 3);
    EXPECT_EQ(v.depth, 2);
    EXPECT_EQ(v.components, 1);
    EXPECT_EQ(v.pixels, data);
  }
  const Volume rgb = decode(nrrd(header("uint8_t", "3 2 1 2", "raw"), data));
  EXPECT_EQ(rgb.components, 3);
  EXPECT_EQ(rgb.width, 2);
  EXPECT_EQ(rgb.depth, 2);
}

// gzip files that are appended to each other are one (RFC 1952, 2.2).
TEST(Volume, NrrdOfSeveralPackedMembers) {
  const Bytes data = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  Bytes members;
  for (const auto& [from, to] : {std::pair{0, 5}, {5, 5}, {5, 12}})
    for (const uint8_t byte : packed({data.begin() + from, data.begin() + to}))
      members.push_back(byte);
  const std::string head = header("uchar", "2 3 2", "gzip");
  EXPECT_EQ(decode(nrrd(head, members)).pixels, data);
  Bytes damaged = packed({1, 2, 3});
  damaged.resize(damaged.size() + 20, 1);
  expectRefused(nrrd(head, damaged), "damaged");
}

// -100 to 300 is the range.
TEST(Volume, OtherNumbersAreScaledByTheirRange) {
  const Bytes little = {0x9c, 0xff, 0x2c, 0x01, 0x64, 0x00}, // -100 300 100
      big = {0xff, 0x9c, 0x01, 0x2c, 0x00, 0x64}, expected = {0, 255, 128};
  EXPECT_EQ(decode(nrrd(header("short", "3 1 1", "raw", "endian: little\n"), little)).pixels,
            expected);
  EXPECT_EQ(decode(nrrd(header("int16", "3 1 1", "raw", "endian: big\n"), big)).pixels, expected);
  EXPECT_EQ(decode(bytesOf(header("float", "3 1 1", "text") + "-1e38 3e38 1e38")).pixels, expected);
  EXPECT_EQ(decode(bytesOf(header("double", "3 1 1", "txt") + "nan 1 1")).pixels, Bytes(3, 0));
}

TEST(Volume, DamagedNrrdFilesAreRefused) {
  expectRefused(bytesOf("NRRD0004"), "the header does not end");
  expectRefused(bytesOf("NRRD0004\ntype: uchar\n"), "the header does not end");
  expectRefused(bytesOf("NRRD0004\n\n"), "lacks type, sizes or encoding");
  expectRefused(bytesOf(header("block", "2 2 2", "raw")), "type \"block\"");
  expectRefused(bytesOf(header("uchar", "2 2 2", "bzip2")), "\"bzip2\"");
  expectRefused(bytesOf(header("uchar", "2 2", "raw")), "2 axes");
  expectRefused(bytesOf(header("uchar", "5 2 2 2", "raw")), "5 numbers");
  expectRefused(bytesOf(header("uchar", "1 2 2 2 2", "raw")), "more than four axes");
  expectRefused(bytesOf(header("uchar", "2 -2 2", "raw")), "\"-2\"");
  expectRefused(bytesOf(header("uchar", "2 2 99999999999999999999", "raw")), "expected a number");
  expectRefused(bytesOf(header("uchar", "2 2 0", "raw")), "without slices");
  expectRefused(bytesOf(header("uchar", "0 2 2", "raw")), "without pixels");
  expectRefused(bytesOf(header("uchar", "2 2 70000", "raw")), "70000 slices");
  expectRefused(bytesOf(header("uchar", "1024 1024 2", "raw")), "imagePixels");
  expectRefused(bytesOf(header("uchar", "65536 65536 65536", "raw")), "imagePixels");
  expectRefused(bytesOf(header("uchar", "4294967296 4294967296 4294967296", "raw")), "slices");
  expectRefused(bytesOf(header("uchar", "2 2 2", "raw") + "1234567"), "ends too early");
  expectRefused(bytesOf(header("uchar", "2 2 2", "ascii") + "1 2 3"), "3 numbers, expected 8");
  expectRefused(bytesOf(header("uchar", "2 2 2", "gzip") + "no gzip data"), "damaged");
  expectRefused(nrrd(header("uchar", "2 2 2", "gzip"), packed({1, 2, 3})), "ends too early");
  Bytes cut = nrrd(header("uchar", "8 8 8", "gzip"), packed(Bytes(512, 7)));
  cut.resize(cut.size() - 12);
  EXPECT_NE(whyNot(cut), "");
  expectRefused(bytesOf(header("uchar", "2 2 2", "raw", "data file: x.raw\n")), "another file");
  expectRefused(bytesOf(header("uchar", "2 2 2", "raw", "byte skip: -1\n")), "skip");
  expectRefused(bytesOf("GIF"), "not an NRRD or DDS file");
  expectRefused({}, "not an NRRD or DDS file");
}

void word(Bytes& to, uint32_t v) {
  for (int i = 0; i < 4; i++) to.push_back(uint8_t(v >> 8 * i));
}
Bytes ddsHeader(uint32_t width, uint32_t height, uint32_t depth, uint32_t caps2 = 0x200000) {
  Bytes b{'D', 'D', 'S', ' '};
  for (const uint32_t v : {124u, 0x801007u, height, width, 0u, depth, 0u}) word(b, v);
  b.resize(76);
  for (const uint32_t v : {32u, 0x20000u, 0u, 8u, 0xffu, 0u, 0u, 0u}) word(b, v); // grey
  for (const uint32_t v : {0x1008u, caps2, 0u, 0u, 0u}) word(b, v);
  return b;
}

// Rows are stored from the top.
TEST(Volume, DdsVolumes) {
  Bytes file = ddsHeader(2, 2, 2);
  file.insert(file.end(), {1, 2, 3, 4, 5, 6, 7, 8});
  const Volume v = decode(file);
  EXPECT_EQ(v.depth, 2);
  EXPECT_EQ(v.pixels, (Bytes{3, 4, 1, 2, 7, 8, 5, 6}));
  file.pop_back();
  expectRefused(file, "ends too early");
  expectRefused(ddsHeader(2, 2, 0), "without slices");
  expectRefused(ddsHeader(2, 2, 0xffffffff), "slices");
  expectRefused(ddsHeader(2, 2, 1, 0xfe00), "cube map");
  Bytes flat = ddsHeader(2, 1, 9, 0);
  flat.insert(flat.end(), {7, 9});
  EXPECT_EQ(decode(flat).depth, 1);
}

TEST(Volume, ListsOfNumbers) {
  const Limits limits;
  const auto of = [&](const std::vector<int32_t>& list) { return volumeOf(list, room(limits)); };
  const Volume v = of({4, 1, 1, 2, 0x01020304, int32_t(0xfffefdfc), 99});
  EXPECT_EQ(v.depth, 2);
  EXPECT_EQ(v.pixels, (Bytes{1, 2, 3, 4, 255, 254, 253, 252}));
  for (const std::vector<int32_t>& none :
       {std::vector<int32_t>{}, {1, 2, 2}, {0, 0, 0, 0}, {0, 2, 2, 2}, {1, 2, 0, 2}, {3, 0, 9, 9}})
    EXPECT_TRUE(of(none).pixels.empty());
  for (const std::vector<int32_t>& wrong : {std::vector<int32_t>{1, 2, 2, 2, 1, 2, 3},
                                            {5, 1, 1, 1, 0},
                                            {-1, 1, 1, 1, 0},
                                            {1, -2, -2, 1, 0},
                                            {1, 65537, 1, 1, 0},
                                            {1, 2147483647, 2147483647, 2147483647, 0}})
    EXPECT_THROW(of(wrong), std::runtime_error);
}

TEST(Volume, StacksHaveTheComponentsOfTheRichest) {
  const Limits limits;
  const Image grey{2, 1, 1, {10, 20}}, color{2, 1, 3, {1, 2, 3, 4, 5, 6}},
      clear{2, 1, 2, {30, 40, 50, 60}}, tall{1, 2, 1, {1, 2}};
  const Volume v = stacked(std::vector<Image>{grey, color, clear}, room(limits));
  EXPECT_EQ(v.components, 4);
  EXPECT_EQ(v.depth, 3);
  EXPECT_EQ(v.pixels, (Bytes{10, 10, 10, 255, 20, 20, 20, 255, 1,  2,  3,  255,
                             4,  5,  6,  255, 30, 30, 30, 40,  50, 50, 50, 60}));
  EXPECT_EQ(stacked(std::vector<Image>{grey, grey}, room(limits)).components, 1);
  EXPECT_TRUE(stacked({}, room(limits)).pixels.empty());
  EXPECT_THROW(stacked(std::vector<Image>{grey, tall}, room(limits)), std::runtime_error);
}

} // namespace
