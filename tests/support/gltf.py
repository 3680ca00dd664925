"""A GLB file read as plain JSON and arrays, without the code that writes it."""

import json
import struct

import numpy as np


def read(path):
    """(document, arrays of all accessors)"""
    data = path.read_bytes()
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    assert length % 4 == 0
    document = json.loads(data[20 : 20 + length])
    binary = data[28 + length :]
    arrays = []
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        kind = np.dtype({5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]])
        raw = np.frombuffer(binary, kind, offset=view["byteOffset"], count=view["byteLength"] // kind.itemsize)
        arrays.append(raw.reshape(accessor["count"], -1))
    return document, arrays
