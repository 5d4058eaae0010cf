"""Reads OpenEXR files as vv writes them: one part, 32-bit floats, ZIP. Only for the tests."""
import struct
import zlib

import numpy as np

ROWS = 16  # in a block of ZIP


def read_exr(data):
    """Returns the attributes {name: (type, bytes)} and the planes {name: rows of float32}."""
    assert data[:4] == b"v/1\x01"
    at, attributes = 8, {}
    while data[at]:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size, = struct.unpack_from("<i", data, type_end + 1)
        attributes[data[at:name_end].decode()] = (data[name_end + 1:type_end].decode(),
                                                  data[type_end + 5:type_end + 5 + size])
        at = type_end + 5 + size
    at += 1
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = right - left + 1, bottom - top + 1
    names = [part.split(b"\0")[0].decode() for part in channels_of(attributes["channels"][1])]
    assert attributes["compression"][1] == b"\x03"
    blocks = -(-height // ROWS)
    rows = {name: np.empty((height, width), np.float32) for name in names}
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        first, size = struct.unpack_from("<2i", data, offset)
        count = min(ROWS, bottom + 1 - first)
        raw = data[offset + 8:offset + 8 + size]
        if size < count * width * 4 * len(names):
            raw = unpacked(raw)
        numbers = np.frombuffer(raw, "<f4").reshape(count, len(names), width)
        for k, name in enumerate(names):
            rows[name][first - top:first - top + count] = numbers[:, k]
    return attributes, rows


def channels_of(data):
    """Splits the list of channels: name, type, linear, reserved, sampling."""
    while data[:1] != b"\0":
        end = data.index(b"\0")
        yield data[:end + 17]
        data = data[end + 17:]


def unpacked(raw):
    """Undoes ZIP: deflate, differences, halves that interleave."""
    bytes_ = np.frombuffer(zlib.decompress(raw), np.uint8).astype(np.int64)
    bytes_[1:] -= 128
    bytes_ = np.cumsum(bytes_) & 255
    out = np.empty(len(bytes_), np.uint8)
    half = (len(bytes_) + 1) // 2
    out[0::2], out[1::2] = bytes_[:half], bytes_[half:]
    return out.tobytes()


def window(attributes, name):
    """Returns x, y, width, height of dataWindow or displayWindow."""
    left, top, right, bottom = struct.unpack("<4i", attributes[name][1])
    return left, top, right - left + 1, bottom - top + 1
