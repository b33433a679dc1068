"""glTF documents with a value replaced end in a MeshError or a sound mesh, never otherwise."""

from __future__ import annotations

import copy
import random
import re

import numpy as np
import pytest
from mesh_files.gltf_documents import draco_square, instanced, meshopt_square, morphing, skinned
from mesh_files.gltf_files import DOCUMENT, glb

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

#: What stands in place of a value: wrong kinds, ends of ranges, numbers that are none.
OTHERS = [
    *(None, True, False, {}, [], "", "x", "TRIANGLES", [0], [None], [[]], {"a": 1}, [1e308] * 3),
    *(-1, 0, 1, 2, 3, 4, 5, 6, 7, 2**31, 2**32, 2**53, 2**64, 10**30, 0.5, -0.5, 1e-300, 1e300),
    *(5120, 5121, 5122, 5123, 5125, 5126, 5130, [0, 0, 0, 0], [1] * 16, [0, 0, 0, 1]),
]
INSIDES = re.compile(r"Error\b|Exception|Traceback|<class|object at 0x")


def places(value, path=()):
    """Yield where every value of a document stands."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in items:
        yield (*path, key)
        if isinstance(inner, dict | list):
            yield from places(inner, (*path, key))


def changed(document, path, value):
    """Return a document with one value replaced, or without it where the value is `places`."""
    result = copy.deepcopy(document)
    item = result
    for key in path[:-1]:
        item = item[key]
    if value is places and isinstance(item, dict):
        del item[path[-1]]
    else:
        item[path[-1]] = None if value is places else copy.deepcopy(value)
    return result


def read(data):
    """Return the mesh, or the words of the error; any other exception fails the test."""
    try:
        return load_mesh_bytes(data, ".glb"), ""
    except MeshError as refused:
        return None, str(refused)


def load_or_refuse(data):
    mesh, words = read(data)
    assert not INSIDES.search(words)
    assert len(words) < 500
    if mesh is None:
        return
    assert np.isfinite(mesh.vertices).all()
    assert mesh.triangles.min() >= 0
    assert mesh.triangles.max() < len(mesh.vertices)


def documents():
    builders = [morphing([1, 0.5]), skinned(sets=2), instanced(TRANSLATION=[[0, 0, 1], [0, 0, 2]])]
    for builder in builders:
        yield builder.document | {"buffers": [{"byteLength": len(builder.body)}]}, builder.body
    yield DOCUMENT, bytes(60)


@pytest.mark.parametrize("number", range(4))
def test_a_document_with_any_value_replaced_never_fails_otherwise(number):
    document, body = list(documents())[number]
    # The first one is looked at whole, of the others every fourth replacement, another one each.
    for row, path in enumerate(places(document)):
        for column, value in enumerate([*OTHERS, places]):
            if number == 3 or (row + column) % 4 == number:
                load_or_refuse(glb(changed(document, path, value), body))


@pytest.mark.parametrize("number", range(4))
def test_a_document_with_several_values_replaced_never_fails_otherwise(number):
    document, body = list(documents())[number]
    draw = random.Random(number)
    for _ in range(300):
        result = document
        for _ in range(draw.randrange(2, 5)):
            path = draw.choice(list(places(result)))
            result = changed(result, path, draw.choice([*OTHERS, places]))
        load_or_refuse(glb(result, body))


@pytest.mark.parametrize(
    "made",
    [
        pytest.param(draco_square, marks=pytest.mark.needs("DracoPy")),
        pytest.param(meshopt_square, marks=pytest.mark.needs("meshopt")),
    ],
)
def test_a_packed_document_with_bytes_or_values_replaced_never_fails_otherwise(made):
    builder = made()
    buffers = [{"byteLength": len(builder.body)}, {"byteLength": 60}]
    document = builder.document | {"buffers": buffers}
    draw = random.Random(1)
    for path in places(document):
        for value in draw.sample([*OTHERS, places], 12):
            load_or_refuse(glb(changed(document, path, value), builder.body))
    for position in range(len(builder.body)):
        body = bytearray(builder.body)
        body[position] = draw.randrange(256)
        load_or_refuse(glb(document, bytes(body)))
    for size in range(len(builder.body)):
        load_or_refuse(glb(document, builder.body[:size] + bytes(len(builder.body) - size)))
