"""Thin first check; superseded below as readers arrive."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh


def test_load_mesh_reads_a_binary_stl_whose_header_starts_with_solid(tmp_path):
    path = tmp_path / "one.stl"
    corners = [0.0, 0, 0, 1, 0, 0, 0, 1, 0]
    record = struct.pack("<12fH", 0, 0, 1, *corners, 0)
    path.write_bytes(b"solid".ljust(80) + struct.pack("<I", 1) + record)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices, np.reshape(corners, (3, 3)))
    np.testing.assert_array_equal(mesh.triangles, [[0, 1, 2]])


def test_load_mesh_refuses_an_obj_face_out_of_range_and_names_the_line(tmp_path):
    path = tmp_path / "gear.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")

    with pytest.raises(MeshError, match=r"gear\.obj:4: face uses vertex 4 of 3; indices start"):
        load_mesh(path)
