"""`obbtree overlap --mesh FILE`: what both share as a mesh, held against the proven volume."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.cli.boundary import OutputError, UsageError, writing
from obbcli.cli.inputs import keep_inputs
from obbcli.errors import ObbError
from obbcli.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.answers.overlap import Overlap
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.report.record import Record


def check_mesh_file(name: str, output: Path | None, inputs: Iterable[str]) -> None:
    """Refuse a file of the shared solid that could not be written, before anything is asked.

    Args:
        name: its file.
        output: where the answer goes; None: to standard output.
        inputs: the files that the command reads.

    Raises:
        UsageError: it is of another kind, or over another file of the command.
        OutputError: its folder is not there.
        ObbError: manifold3d is not installed.
    """
    from obbcli.view.shared_solid import require_package

    if Path(name).suffix.lower() != ".glb":
        raise UsageError(f"--mesh {name}", "is no .glb file", "name one that is")
    if output is not None and Path(name).resolve() == output.resolve():
        raise UsageError(f"--mesh {name}", "is where the answer goes", "name another file")
    if not Path(name).resolve().parent.is_dir():
        raise OutputError(name, "cannot be written: its folder is not there", "create it first")
    keep_inputs(Path(name), inputs)
    require_package("--mesh")


def require_solids(pair: PairQuestion) -> None:
    """Refuse bodies that share no solid, as one does not close.

    Raises:
        MeshError: the message says where, and which welding closes it.
    """
    from obbcli.questions.containment import require_watertight

    for name, tree in zip("AB", pair.trees, strict=True):
        require_watertight(tree.mesh, f"{name} ({tree.source})" if tree.source else name)


def write_shared_mesh(name: str, pair: PairQuestion, answer: Overlap) -> Record:
    """Write what two solids share, and return what the record says of it.

    Nothing is written where they share nothing.

    Args:
        name: the file.
        pair: both, which close.
        answer: about them, whose volume it is held against.

    Raises:
        ObbError: it cannot be written, or manifold3d takes a mesh for no solid.
    """
    from obbcli.report.shared_mesh import shared_mesh_part
    from obbcli.view.gltf import glb_bytes
    from obbcli.view.shared_solid import shared_solid

    solid = shared_solid(pair.bodies)
    byte_count = None
    if len(solid.triangles):
        try:
            data = glb_bytes(solid.picture())
        except ObbError as fault:
            raise ObbError(name, fault.fault, "choose other units, or shift it") from fault
        with writing(Path(name)):
            write_whole(Path(name), data)
        byte_count = len(data)
    return shared_mesh_part(name, solid, byte_count, answer.volume)
