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


def load(content, body=POSITIONS + INDICES):
    return load_mesh_bytes(glb(content, body), ".glb")
