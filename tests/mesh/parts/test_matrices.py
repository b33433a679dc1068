"""Matrices of parts: turned, mirrored, uneven, nested, by the definition in rational arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from claims.parts import corners, require_whole
from hypothesis import given
from hypothesis import strategies as st
from mesh_files import collada_files, threemf_files
from mesh_files.cube_files import CUBE_FACES, cube
from mesh_files.gltf_files import Builder, glb

from obbcli import Mesh, distance, load_mesh, load_parts
from obbcli.mesh import load_mesh_bytes

CUBE = np.array(cube())
ROOT = math.sqrt(0.5)
MATRICES = {
    "turned": [[ROOT, -ROOT, 0, 1], [ROOT, ROOT, 0, 2], [0, 0, 1, 3]],
    "mirrored": [[-1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0]],
    "uneven": [[1, 0, 0, 0.7], [0, 3.1, 0, 0], [0, 0, 0.1, 5]],
    "sheared": [[1, 0.3, 0, 0], [0, 1, 0, 0.2], [0, 0, 1, 0]],
    "mirrored and uneven": [[0, 2.5, 0, 0], [0.7, 0, 0, 0], [0, 0, 1.1, 9]],
    "inside out": [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0.3]],
}


def gltf(*nested):
    """Return a glTF file of a cube below nodes with these matrices, the outermost first."""
    nodes = [
        {"name": f"n{k}", "matrix": np.vstack([m, [0, 0, 0, 1]]).T.ravel().tolist()}
        for k, m in enumerate(nested)
    ]
    for k, node in enumerate(nodes[:-1]):
        node["children"] = [k + 1]
    nodes[-1]["mesh"] = 0
    made = Builder(nodes=nodes)
    attributes = {"POSITION": made.accessor(cube())}
    indices = made.accessor(np.ravel(CUBE_FACES), "<u2")
    made.document["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
    return glb(made.document | {"buffers": [{"byteLength": len(made.body)}]}, made.body)


def threemf(*nested):
    """Return a 3MF file of a cube in components with these matrices, in an item's."""
    words = [
        f'transform="{" ".join(map(repr, np.array(m, float).T.ravel().tolist()))}"' for m in nested
    ]
    rows = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in cube())
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in CUBE_FACES)
    shape = f"<mesh><vertices>{rows}</vertices><triangles>{faces}</triangles></mesh>"
    last = len(words)
    made = threemf_files.mesh(last, f'name="n{last - 1}"', shape)
    for key in range(last - 1, 0, -1):
        made += threemf_files.group(key, (str(key + 1), words[key]), more=f'name="n{key - 1}"')
    return threemf_files.archive(threemf_files.model(made, f'<item objectid="1" {words[0]}/>'))


def collada(*nested):
    """Return a COLLADA document of a cube below nodes with these matrices, the outermost first."""
    points = " ".join(" ".join(map(repr, row)) for row in cube())
    numbers = " ".join(" ".join(map(str, face)) for face in CUBE_FACES)
    shape = collada_files.geometry(
        collada_files.triangles(numbers), "g", 'count="8" stride="3"', points
    )
    content = '<instance_geometry url="#g"/>'
    for k, matrix in reversed(list(enumerate(nested))):
        rows = " ".join(map(repr, np.vstack([matrix, [0, 0, 0, 1]]).astype(float).ravel().tolist()))
        content = f'<node name="n{k}"><matrix>{rows}</matrix>{content}</node>'
    return collada_files.document(content, shape)


WRITERS = {".glb": gltf, ".3mf": threemf, ".dae": collada}


def placed(matrix):
    """Return the cube as the definition places it, every sum rounded from the left."""
    rows = [
        [float(sum_) for sum_ in (((m[0] * x + m[1] * y) + m[2] * z) + m[3] for m in matrix)]
        for x, y, z in CUBE.tolist()
    ]
    return np.array(rows)


def volume(mesh):
    """Return the volume that a surface holds, exactly; negative where it is inside out."""
    total = Fraction(0)
    for triangle in corners(mesh).tolist():
        (a, b, c), (d, e, f), (g, h, i) = (map(Fraction, row) for row in triangle)
        total += a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return total / 6


def determinant(matrix):
    (a, b, c), (d, e, f), (g, h, i) = (map(Fraction, row[:3]) for row in matrix)
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


@pytest.mark.parametrize("suffix", list(WRITERS))
@pytest.mark.parametrize("name", list(MATRICES))
def test_matrix_places_each_vertex_as_its_definition_says(tmp_path, suffix, name):
    matrix = MATRICES[name]
    path = tmp_path / f"a{suffix}"
    path.write_bytes(WRITERS[suffix](matrix))

    (part,) = load_parts(path)

    assert load_mesh(path).vertices.tobytes() == (placed(matrix) + 0.0).tobytes()
    require_whole(path)
    # What no pose can do is done in the mesh: a pose turns and shifts alone.
    linear = np.array(part.pose.rotation)
    np.testing.assert_allclose(linear @ linear.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(linear) > 0
    assert np.array_equal(part.mesh.vertices, CUBE) == (name == "turned")


@pytest.mark.parametrize("suffix", list(WRITERS))
@pytest.mark.parametrize("name", list(MATRICES))
def test_outside_of_a_mirrored_part_stays_outside(suffix, name):
    found = load_mesh_bytes(WRITERS[suffix](MATRICES[name]), suffix)

    wanted = abs(determinant(MATRICES[name]))
    assert abs(volume(found) - wanted) < Fraction(1, 10**12) * wanted


@pytest.mark.parametrize("suffix", list(WRITERS))
@pytest.mark.parametrize("name", list(MATRICES))
def test_placed_part_answers_as_a_mesh_that_is_placed_bit_for_bit(tmp_path, suffix, name):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(WRITERS[suffix](MATRICES[name]))
    (part,) = load_parts(path)
    probe = Mesh(np.array(cube((3.3, 0.2, 0.4))) * 0.7, CUBE_FACES, unit=part.unit)

    for swapped in (False, True):
        placed, baked = (
            distance(*((probe, one) if swapped else (one, probe)))
            for one in (part, load_mesh(path))
        )
        assert (placed.bounds, placed.triangle_a, placed.triangle_b) == (
            *(baked.bounds, baked.triangle_a),
            baked.triangle_b,
        )


@pytest.mark.parametrize("suffix", list(WRITERS))
def test_nested_matrices_are_multiplied_from_the_root_down(tmp_path, suffix):
    nested = [MATRICES[name] for name in ("turned", "uneven", "mirrored")]
    path = tmp_path / f"a{suffix}"
    path.write_bytes(WRITERS[suffix](*nested))

    (part,) = load_parts(path)

    assert part.path == "n0/n1/n2"
    exact = []
    for row in CUBE.tolist():
        point = [Fraction(x) for x in row]
        for matrix in reversed(nested):
            point = [
                sum((Fraction(w) * x for w, x in zip(line, point, strict=False)), Fraction(line[3]))
                for line in matrix
            ]
        exact.append([float(x) for x in point])
    np.testing.assert_allclose(load_mesh(path).vertices, exact, rtol=0, atol=1e-14)
    assert volume(load_mesh(path)) > 0
    require_whole(path)


@given(
    st.lists(st.integers(-4, 4), min_size=9, max_size=9),
    st.lists(st.integers(-40, 40), min_size=3, max_size=3),
    st.sampled_from(list(WRITERS)),
)
def test_matrices_of_whole_numbers_are_exact(linear, shift, suffix):
    matrix = np.hstack([np.reshape(linear, (3, 3)), np.reshape(shift, (3, 1))]).tolist()

    found = load_mesh_bytes(WRITERS[suffix](matrix), suffix)

    wanted = CUBE @ np.reshape(linear, (3, 3)).T + np.array(shift)
    assert found.vertices.tolist() == wanted.tolist()
    assert volume(found) == abs(determinant(matrix))
