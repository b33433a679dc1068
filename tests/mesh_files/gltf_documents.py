"""glTF documents that use more than nodes and triangles, for tests and fuzzers."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.gltf_files import SQUARE, Builder, glb

from obbcli.mesh.formats.gltf.compressed import DRACO

TRIANGLES = [[0, 1, 2], [0, 2, 3]]
MESHOPT = "EXT_meshopt_compression"


def morphing(mesh_weights=None, node_weights=None, shifts=(10, 5), **dtype):
    """Return a square whose targets move it along x and then along y."""
    builder = Builder()
    primitive = {"attributes": {"POSITION": builder.accessor(SQUARE)}, "mode": 6, "targets": []}
    for axis, shift in enumerate(shifts):
        rows = np.zeros((4, 3))
        rows[:, axis] = shift
        primitive["targets"].append({"POSITION": builder.accessor(rows, **dtype)})
    weights = {} if mesh_weights is None else {"weights": mesh_weights}
    builder.document["meshes"] = [{"primitives": [primitive], **weights}]
    weights = {} if node_weights is None else {"weights": node_weights}
    builder.document["nodes"] = [{"mesh": 0, **weights}]
    return builder


#: Two joints: the first at rest where it was bound, the second bound at x = 1 and turned a quarter
#: about z, so that what it holds turns about (1, 0, 0).
QUARTER = [0.0, 0.0, 0.5**0.5, 0.5**0.5]
BINDS = [np.eye(4), np.eye(4)]
BINDS[1] = np.array([[1, 0, 0, -1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
STRIP = [[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0, 1]]


def skinned(
    weights=((1, 0), (0.5, 0.5), (0, 1), (0, 1)), joints=(0, 1), dtype="<f4", sets=1, **more
):
    """Return a strip of two triangles whose far end its second joint holds."""
    builder = Builder()
    attributes = {"POSITION": builder.accessor(STRIP)}
    held = np.zeros((4, 4 * sets))
    shares = np.zeros((4, 4 * sets))
    held[:, [0, -1]] = joints
    shares[:, [0, -1]] = np.asarray(weights, dtype=float)
    held = np.where(shares > 0, held, 0)
    for k in range(sets):
        columns = slice(4 * k, 4 * k + 4)
        attributes[f"JOINTS_{k}"] = builder.accessor(held[:, columns], "<u1")
        attributes[f"WEIGHTS_{k}"] = builder.accessor(shares[:, columns], dtype, **more)
    binds = np.array(BINDS).transpose(0, 2, 1).reshape(2, 16)
    skin = {"joints": [1, 2], "inverseBindMatrices": builder.accessor(binds)}
    builder.document |= {
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            # The node that carries the mesh places nothing, whatever it says.
            {"mesh": 0, "skin": 0, "translation": [99, 99, 99]},
            {"children": [2]},
            {"translation": [1, 0, 0], "rotation": QUARTER},
        ],
        "skins": [skin],
        "meshes": [{"primitives": [{"attributes": attributes, "mode": 5}]}],
    }
    return builder


def instanced(dtype="<f4", **values):
    """Return the square with a node of instances that stands at y = 100."""
    builder = Builder()
    primitive = {"attributes": {"POSITION": builder.accessor(SQUARE)}, "mode": 6}
    more = {} if dtype == "<f4" else {"normalized": True}
    attributes = {
        name: builder.accessor(rows, dtype if name == "ROTATION" else "<f4", **more)
        for name, rows in values.items()
    }
    extensions = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    builder.document |= {
        "extensionsUsed": ["EXT_mesh_gpu_instancing"],
        "nodes": [{"mesh": 0, "translation": [0, 100, 0], "extensions": extensions}],
        "meshes": [{"primitives": [primitive]}],
    }
    return builder


def meshopt_square(required=True, name=MESHOPT, codes="TRIANGLES", **changes):
    """Return a square whose positions and indices are packed by meshoptimizer.

    With a filter among the changes of both views, positions go through that of exponents.
    """
    codec = pytest.importorskip("meshopt")
    builder = Builder(extensionsUsed=[name])
    if required:
        builder.document["extensionsRequired"] = [name]
    positions = np.asarray(SQUARE, "<f4")
    if "filter" in changes:
        positions = codec.encode_filter_exp(positions, 15)
    indices = np.asarray(TRIANGLES, "<u2").reshape(-1)
    packed = [
        (codec.encode_gltf_buffer(positions, "ATTRIBUTES"), 12, 4, "ATTRIBUTES", 48),
        (codec.encode_gltf_buffer(indices, codes), 2, 6, codes, 12),
    ]
    for data, stride, count, kind, length in packed:
        view = builder.view(data)
        item = builder.document["bufferViews"][view]
        extension = {"buffer": 0, "byteOffset": item["byteOffset"], "byteLength": len(data)}
        extension |= {"byteStride": stride, "count": count, "mode": kind}
        extension |= changes if kind == "ATTRIBUTES" or "filter" not in changes else {}
        item |= {"buffer": 1, "byteOffset": 0, "byteLength": length}
        item["extensions"] = {name: extension}
    builder.document["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    builder.document |= {"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]}
    return builder


def with_fallback(builder, uri=None):
    """Return the file with a second buffer, which the packed one stands for."""
    fallback = {"byteLength": 60, "extensions": {MESHOPT: {"fallback": True}}}
    if uri is not None:
        fallback["uri"] = uri
    buffers = [{"byteLength": len(builder.body)}, fallback]
    return glb(builder.document | {"buffers": buffers}, builder.body)


def draco_square(required=True, normalized=False):
    """Return a square whose triangles are packed by Draco, without loss."""
    codec = pytest.importorskip("DracoPy")
    dtype = "<u2" if normalized else "<f4"
    points = np.asarray(SQUARE, dtype) * (65535 if normalized else 1)
    faces = np.asarray(TRIANGLES, np.uint32)
    data = codec.encode(points, faces, quantization_bits=16, preserve_order=True)
    key = codec.decode(data).attributes[0]["unique_id"]
    builder = Builder(extensionsUsed=[DRACO])
    if required:
        builder.document["extensionsRequired"] = [DRACO]
    extension = {"bufferView": builder.view(data), "attributes": {"POSITION": key}}
    more = {"normalized": True} if normalized else {}
    primitive = {
        "attributes": {"POSITION": builder.form((4, 3), dtype, **more)},
        "indices": builder.form((6,), "<u2"),
        "extensions": {DRACO: extension},
    }
    builder.document |= {"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]}
    return builder
