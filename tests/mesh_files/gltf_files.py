"""A square as a glTF document, with changes."""

from __future__ import annotations

import copy
import json
import struct

import numpy as np

from obbcli.mesh import load_mesh_bytes

SQUARE = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
POSITIONS = struct.pack("<12f", *np.ravel(SQUARE))
INDICES = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
DOCUMENT = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
    ],
    "bufferViews": [
        {"buffer": 0, "byteOffset": 0, "byteLength": 48},
        {"buffer": 0, "byteOffset": 48, "byteLength": 12},
    ],
    "buffers": [{"byteLength": 60}],
}


def document(**changes):
    return copy.deepcopy(DOCUMENT) | changes


def glb(content, body=POSITIONS + INDICES):
    text = content if isinstance(content, bytes) else json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<2I", len(body), 0x004E4942) + body
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def shifted(x, y=0.0, z=0.0):
    """Return the square somewhere else."""
    return np.array(SQUARE) + np.array([x, y, z])


def load(content, body=POSITIONS + INDICES):
    return load_mesh_bytes(glb(content, body), ".glb")


class Builder:
    """Puts arrays into a document and its binary chunk.

    Args:
        changes: keys of the document beside accessors, buffer views and buffers.
    """

    def __init__(self, **changes):
        self.body = b""
        self.document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "accessors": [],
            "bufferViews": [],
            **changes,
        }

    def view(self, data, **more):
        """Return the index of a new buffer view of these bytes, on a multiple of four."""
        self.body += b"\0" * (-len(self.body) % 4)
        view = {"buffer": 0, "byteOffset": len(self.body), "byteLength": len(data)}
        self.body += data
        self.document["bufferViews"].append(view | more)
        return len(self.document["bufferViews"]) - 1

    def accessor(self, values, dtype="<f4", **more):
        """Return the index of a new accessor of these rows."""
        array = np.asarray(values, dtype)
        view = self.view(array.tobytes())
        return self.form(array.shape, dtype, bufferView=view, **more)

    def form(self, shape, dtype="<f4", **more):
        """Return the index of a new accessor that only says what its values are."""
        width = 1 if len(shape) == 1 else shape[1]
        kinds = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
        codes = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126, "f8": 5130}
        accessor = {"componentType": codes[dtype[-2:]], "count": shape[0], "type": kinds[width]}
        self.document["accessors"].append(accessor | more)
        return len(self.document["accessors"]) - 1

    def glb(self):
        """Return the file."""
        return glb(self.document | {"buffers": [{"byteLength": len(self.body)}]}, self.body)

    def load(self):
        """Return the mesh."""
        return load_mesh_bytes(self.glb(), ".glb")
