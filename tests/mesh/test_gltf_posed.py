"""glTF at rest: morph targets at their default weights, skins as their joints hold them.

Values are worked out by hand from glTF 2.0, 3.7.2.2 and 3.7.3; VTK's reader is the second opinion.
"""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.gltf_documents import STRIP, morphing, skinned
from mesh_files.gltf_files import shifted

from obbcli.errors import MeshError
from obbcli.mesh.formats.gltf.compressed import DRACO


@pytest.mark.parametrize(
    ("mesh_weights", "node_weights", "moved"),
    [
        (None, None, [0, 0, 0]),
        ([0, 0], None, [0, 0, 0]),
        ([1, 0], None, [10, 0, 0]),
        ([0.5, 2], None, [5, 10, 0]),
        ([1, 1], [0, 0.5], [0, 2.5, 0]),  # the node's count before the mesh's
        (None, [-1, 0], [-10, 0, 0]),
    ],
)
def test_gltf_moves_vertices_by_default_weights(mesh_weights, node_weights, moved):
    mesh = morphing(mesh_weights, node_weights).load()

    assert mesh.vertices.tolist() == shifted(*moved).tolist()
    told = "morph targets stand at their default weights" in mesh.notes
    assert told == any(moved)


def test_gltf_scales_targets_of_normalised_integers():
    mesh = morphing([1, 0], shifts=(127, 0), dtype="<i1", normalized=True).load()

    assert mesh.vertices.tolist() == shifted(1, 0, 0).tolist()


def test_gltf_takes_targets_that_move_no_positions():
    builder = morphing([1, 1])
    builder.document["meshes"][0]["primitives"][0]["targets"][0] = {"NORMAL": 0}

    assert builder.load().vertices.tolist() == shifted(0, 5, 0).tolist()


@pytest.mark.parametrize(
    ("weights", "fault"),
    [
        ([1], r"primitives\[0\]: has 2 morph targets, but 1 weights"),
        ([1, 1, 1], r"primitives\[0\]: has 2 morph targets, but 3 weights"),
        ([1, "1"], r"meshes\[0\].weights: expected finite numbers"),
        ({"0": 1}, r"meshes\[0\].weights: expected finite numbers"),
    ],
)
def test_gltf_refuses_weights_that_do_not_fit_the_targets(weights, fault):
    with pytest.raises(MeshError, match=fault):
        morphing(weights).load()


def test_gltf_refuses_a_target_of_another_length():
    builder = morphing([1, 1])
    short = builder.accessor(np.zeros((3, 3)))
    builder.document["meshes"][0]["primitives"][0]["targets"][1] = {"POSITION": short}

    with pytest.raises(MeshError, match=r"targets\[1\]: moves 3 vertices of 4"):
        builder.load()


# The quarter turn takes (2, 0, 0) to (1, 1, 0); (1, 0, 0) is where both joints agree.
POSED = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]]


@pytest.mark.parametrize("sets", [1, 2, 3])
def test_gltf_poses_skins_by_their_joints(sets):
    mesh = skinned(sets=sets).load()

    np.testing.assert_allclose(mesh.vertices, POSED, atol=1e-7)
    assert mesh.triangles.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert "skins stand as their joints hold them at rest" in mesh.notes


def test_gltf_poses_skins_by_joints_that_something_above_them_places():
    builder = skinned()
    builder.document["nodes"].append({"children": [1], "translation": [0, 0, 7]})
    builder.document["scenes"] = [{"nodes": [3, 0]}]

    np.testing.assert_allclose(builder.load().vertices, np.add(POSED, [0, 0, 7]), atol=1e-7)


def test_gltf_poses_skins_without_inverse_bind_matrices():
    builder = skinned()
    del builder.document["skins"][0]["inverseBindMatrices"]

    # The second joint then turns about the origin and moves by 1: (2, 0, 0) to (1, 2, 0).
    expected = [[0, 0, 0], [1, 0.5, 0], [1, 2, 0], [1, 2, 1]]
    np.testing.assert_allclose(builder.load().vertices, expected, atol=1e-7)


def test_gltf_takes_weights_of_bytes_by_their_sum():
    # 128 and 127 of 255 add up to 1, but their halves are not equal.
    weights = ((255, 0), (128, 127), (0, 255), (0, 255))

    mesh = skinned(weights, dtype="<u1", normalized=True).load()

    np.testing.assert_allclose(mesh.vertices, POSED, atol=1e-7)


def test_gltf_divides_weights_by_their_sum_and_says_where_that_is_far_from_one():
    mesh = skinned(((0.5, 0), (0.25, 0.25), (0, 0.5), (0, 1))).load()

    np.testing.assert_allclose(mesh.vertices, POSED, atol=1e-7)
    assert "add up to 1 only within 0.5" in "; ".join(mesh.notes)


def test_gltf_leaves_alone_weights_of_vertices_that_no_triangle_uses():
    builder = skinned(((1, 0), (0.5, 0.5), (0, 1), (0, 0)))
    builder.document["meshes"][0]["primitives"][0] |= {
        "indices": builder.accessor([0, 1, 2], "<u2"),
        "mode": 4,
    }

    np.testing.assert_allclose(builder.load().vertices[:3], POSED[:3], atol=1e-7)


def test_gltf_morphs_before_it_poses():
    builder = skinned(((0, 1),) * 4)
    target = builder.accessor([[1, 0, 0]] * 4)
    builder.document["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": target}]
    builder.document["meshes"][0]["weights"] = [1]

    # x + 1 is turned about (1, 0, 0): (x, y, z) stands at (1 - y, x, z).
    expected = [[1, 0, 0], [1, 1, 0], [1, 2, 0], [1, 2, 1]]
    np.testing.assert_allclose(builder.load().vertices, expected, atol=1e-7)


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ({"joints": (0, 2)}, r"primitives\[0\]: vertex 1 is held by joint 2 of 2"),
        ({"weights": ((0, 0),) * 4}, r"vertex 0 is held by no joint"),
        ({"weights": ((1, -1),) * 4}, "weights that are negative"),
        ({"weights": ((np.nan, 1),) * 4}, "weights that are negative or not finite"),
    ],
)
def test_gltf_refuses_bindings_that_hold_nothing(options, fault):
    with pytest.raises(MeshError, match=fault):
        skinned(**options).load()


@pytest.mark.parametrize(
    ("path", "value", "fault"),
    [
        (["nodes", 0, "skin"], 3, "skins: has no item 3"),
        (["skins", 0, "joints"], [], r"skins\[0\]: has no joints"),
        (["skins", 0, "joints"], [1, 9], "nodes: has no item 9"),
        (["skins", 0, "joints"], [1, 2, 0], "has 2 inverse bind matrices for 3 joints"),
        (["skins", 0, "inverseBindMatrices"], 0, "not of a known type with 16 components"),
        (["meshes", 0, "primitives", 0, "attributes", "JOINTS_0"], 0, "known type with 4"),
        (["meshes", 0, "primitives", 0, "attributes", "JOINTS_0"], 2, "JOINTS_0 of no unsigned"),
        (["nodes", 1, "children"], [1], "is met twice"),
    ],
)
def test_gltf_refuses_skins_that_are_out_of_place(path, value, fault):
    builder = skinned()
    item = builder.document
    for key in path[:-1]:
        item = item[key]
    item[path[-1]] = value

    with pytest.raises(MeshError, match=fault):
        builder.load()


def test_gltf_refuses_a_skin_for_a_mesh_without_joints():
    builder = skinned()
    del builder.document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"]

    with pytest.raises(MeshError, match=r"primitives\[0\]: has no JOINTS_0"):
        builder.load()


def vertices_by_vtk(path):
    """Return the vertices that VTK's reader gives of a file with one mesh."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkGLTFReader

    reader = vtkGLTFReader()
    reader.SetFileName(str(path))
    reader.ApplyDeformationsToGeometryOn()
    reader.Update()
    leaf = reader.GetOutput()
    while not leaf.IsA("vtkPolyData"):
        leaf = leaf.GetBlock(0)
    return vtk_to_numpy(leaf.GetPoints().GetData())


@pytest.mark.needs("vtk")
@pytest.mark.parametrize("seed", range(4))
def test_gltf_poses_as_vtk_does(tmp_path, seed):
    random = np.random.default_rng(seed)
    shares = random.uniform(0.05, 1, (4, 2))
    builder = skinned(shares / shares.sum(axis=1, keepdims=True))
    turn = random.normal(size=4)
    builder.document["nodes"][2] |= {
        "rotation": (turn / np.linalg.norm(turn)).tolist(),
        "translation": random.normal(size=3).tolist(),
        "scale": random.uniform(0.5, 2, 3).tolist(),
    }
    path = tmp_path / "skin.glb"
    path.write_bytes(builder.glb())

    np.testing.assert_allclose(builder.load().vertices, vertices_by_vtk(path), atol=1e-5)


@pytest.mark.needs("vtk")
@pytest.mark.parametrize("node_weights", [None, [0.25, -2]])
def test_gltf_morphs_as_vtk_does(tmp_path, node_weights):
    builder = morphing([0.75, 0.5], node_weights)
    path = tmp_path / "morph.glb"
    path.write_bytes(builder.glb())

    np.testing.assert_allclose(builder.load().vertices, vertices_by_vtk(path), atol=1e-6)


@pytest.mark.needs("DracoPy")
def test_gltf_poses_skins_that_draco_has_packed():
    import DracoPy

    builder = skinned()
    primitive = builder.document["meshes"][0]["primitives"][0]
    held = np.array([[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 1], [0, 0, 0, 1]], np.uint8)
    shares = np.array([[1, 0, 0, 0], [0.5, 0, 0, 0.5], [0, 0, 0, 1], [0, 0, 0, 1]], np.float32)
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.uint32)
    data = DracoPy.encode(
        np.array(STRIP, np.float32),
        faces,
        quantization_bits=16,
        preserve_order=True,
        generic_attributes={7: held, 8: shares},
    )
    key = next(a["unique_id"] for a in DracoPy.decode(data).attributes if a["attribute_type"] == 0)
    ids = {"POSITION": key, "JOINTS_0": 7, "WEIGHTS_0": 8}
    primitive["attributes"] = {
        "POSITION": builder.form((4, 3)),
        "JOINTS_0": builder.form((4, 4), "<u1"),
        "WEIGHTS_0": builder.form((4, 4)),
    }
    primitive["mode"] = 4
    primitive["extensions"] = {DRACO: {"bufferView": builder.view(data), "attributes": ids}}
    builder.document["extensionsRequired"] = [DRACO]

    np.testing.assert_allclose(builder.load().vertices, POSED, atol=1e-4)
