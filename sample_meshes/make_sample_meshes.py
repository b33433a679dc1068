"""Makes the sample meshes: parts that nearly touch, at their working places.

    python sample_meshes/make_sample_meshes.py [DIRECTORY]

writes them next to this script, or into DIRECTORY; every machine writes the same bytes. Lengths are
in mm. Parts of one story share one coordinate system, in which none of them touches another.

================= ========================== ========================================== =========
file              format                     what                                       triangles
================= ========================== ========================================== =========
gear.stl          binary STL                 36 involute teeth, module 2, axis z            11520
pinion.stl        binary STL                 18 teeth in mesh with it, axis at x = 54        4560
bolt.ply          binary PLY, little-endian  M16 x 2, bearing face z = 0, axis z             8504
nut.obj           OBJ, quads                 on the bolt, 3 turns above its head             3896
chain_link_a.off  OFF, quads                 link of 5 mm wire                               1216
chain_link_b.ply  ASCII PLY, quads           the link hooked into it, 2 mm of slack          1216
robot_link.ply    binary PLY, big-endian     arm, base axis z, wrist axis at x = 120         1604
gripper_palm.glb  GLB, 3 nodes of 2 meshes   palm below the wrist, two rails                  144
finger_left.off   OFF, quads and triangles   finger at positive y, 5 mm off the pin           304
finger_right.off  OFF, quads and triangles   finger at negative y                             304
workpiece.obj     OBJ, 2 objects, polygons   pin of 20 mm on a pallet, below the wrist        312
housing.stl       ASCII STL                  open tray, walls and floor 0.2 mm thin           800
board.vtk         VTK, 172 hexahedra         board 0.05 mm off the tray's walls, floor        796
degenerate.ply    ASCII PLY                  points, segments, doubles, needles                14
================= ========================== ========================================== =========
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from fasteners import bolt, nut
from gears import gear, pinion
from parts import (
    WRIST_X,
    board,
    chain_link,
    finger,
    housing,
    next_chain_link,
    opposite_finger,
    palm_housing,
    palm_rail,
    robot_link,
    workpiece,
)
from surfaces import Face, Surface
from writers import (
    Node,
    write_glb,
    write_obj,
    write_off,
    write_ply_ascii,
    write_ply_binary,
    write_stl_ascii,
    write_stl_binary,
    write_vtk_hexahedra,
)


def degenerate() -> Surface:
    """Return what meshes in the wild have in them: doubled, flat, thin, lost and lone triangles."""
    corners = [
        *[(0, 0, 0), (10, 0, 0), (0, 10, 0)],  # 0: an honest triangle; 1 and 2 are doubles of it
        *[(4, 4, 4), (4, 4, 4), (4, 4, 4)],  # 3: a point, of three equal vertices
        *[(-5, -5, 5)],  # 4: a point, of one vertex named three times
        *[(20, 0, 1), (24, 2, 2), (32, 6, 4)],  # 5: a segment, of three points in line
        *[(20, 5, 0), (25, 5, 0)],  # 6: a segment, of an edge and back
        *[(0, 20, 0), (100, 20, 0), (100, 20.001, 0)],  # 7: a needle
        *[(0, 30, 0), (10, 30, 0), (5, 30.000001, 0)],  # 8: a sliver, one millionth thin
        *[(2, 2, 0), (12, 2, 0), (2, 12, 0)],  # 9: overlaps 0 in its plane
        *[(1, 1, 0), (3, 1, 0), (1, 3, 0)],  # 10: lies inside 0
        *[(5, 0, 0), (10, 0, 0), (5, -8, 0)],  # 11: shares half an edge with 0
        *[(1e6, 1e6, 1e6), (1e6 + 1, 1e6, 1e6), (1e6, 1e6 + 1, 1e6)],  # 12: alone, far off
        *[(-1, 0, 0), (-0.999999, 0, 0), (-1, 0.000001, 0)],  # 13: one millionth small
        *[(50, 50, 50)],  # no triangle's vertex
    ]
    faces: list[Face] = [(0, 1, 2), (0, 1, 2), (2, 1, 0), (3, 4, 5), (6, 6, 6), (7, 8, 9)]
    faces += [(10, 11, 10), *((first, first + 1, first + 2) for first in range(12, 33, 3))]
    return Surface(np.array(corners, dtype=np.float64), faces)


def make_all(directory: Path) -> None:
    """Write every sample mesh into the directory."""
    write_stl_binary(directory / "gear.stl", gear(), "gear, 36 teeth, module 2 mm")
    write_stl_binary(directory / "pinion.stl", pinion(), "pinion, 18 teeth, module 2 mm")
    write_ply_binary(directory / "bolt.ply", bolt(), "bolt M16 x 2")
    write_obj(directory / "nut.obj", {"nut": nut()}, "nut M16 x 2")
    write_off(directory / "chain_link_a.off", chain_link())
    write_ply_ascii(directory / "chain_link_b.ply", next_chain_link(), "chain link")
    write_ply_binary(directory / "robot_link.ply", robot_link(), "robot link", big_endian=True)
    wrist = (WRIST_X, 0.0, 0.0)
    half_turn = (0.0, 0.0, 1.0, 0.0)
    nodes = [Node("housing", 0, wrist), Node("rail", 1, wrist), Node("rail_2", 1, wrist, half_turn)]
    palm = {"housing": palm_housing(), "rail": palm_rail()}
    write_glb(directory / "gripper_palm.glb", palm, nodes)
    write_off(directory / "finger_left.off", finger())
    write_off(directory / "finger_right.off", opposite_finger())
    write_obj(directory / "workpiece.obj", workpiece(), "pin on a pallet")
    write_stl_ascii(directory / "housing.stl", housing(), "housing")
    write_vtk_hexahedra(directory / "board.vtk", *board(), "board")
    write_ply_ascii(directory / "degenerate.ply", degenerate(), "degenerate triangles")


if __name__ == "__main__":
    make_all(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
