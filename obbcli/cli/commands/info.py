"""`obbtree info`: what a mesh or tree file holds."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import UsageError
from obbcli.cli.inputs import keep_inputs, read_piped, read_shape
from obbcli.cli.options.option import Command, common_options, option, verify_option
from obbcli.cli.options.placement import (
    UnitOptions,
    sag_option,
    scale_option,
    unit_option,
    weld_option,
)
from obbcli.cli.options.words import PathName
from obbcli.cli.output import emit
from obbcli.errors import MeshError

if TYPE_CHECKING:
    from obbcli.cli.options.option import CommonOptions
    from obbcli.motion.assembly import Assembly


@click.command(
    "info",
    cls=Command,
    short_help="What a mesh or tree file holds.",
    epilog="""\b
Examples:
  obbtree info gear.stl
  obbtree info gear.obbt --check
  obbtree info gear.obbt --json
  obbtree info robot.glb --parts
  obbtree info gear.stl --unit mm --scale 25.4
""",
)
@click.argument("file", metavar="FILE", type=PathName())
@option("Question", "--check", is_flag=True, help="Prove every box and checksum of the tree.")
@option(
    "Question",
    "--overlaps-itself",
    is_flag=True,
    help="Tell of a mesh of more than 20,000 triangles, too, whether it overlaps itself.",
)
@option("Question", "--parts", is_flag=True, help="List the parts of a mesh file, placed.")
@unit_option
@scale_option("--scale", "the mesh's")
@weld_option
@sag_option
@verify_option
@common_options()
def command(file: str, common: CommonOptions, **flags: Any) -> int:
    """Show what FILE holds: a mesh, or a tree with the mesh inside it.

    Counts, size, whether the surface closes and overlaps itself, its volume, degenerate and
    repeated triangles; of a tree also its levels, how it was built, and whether the mesh file
    beside it has changed since. --check over a mesh builds its tree and proves that.
    """
    from obbcli.files import file_of, stamp_of
    from obbcli.mesh import Mesh
    from obbcli.report.info import info_record, info_tables
    from obbcli.report.record import file_sha256
    from obbcli.tree.tree import ObbTree

    keep_inputs(common.output, (file,))
    sag = flags["sag"]
    lengths = UnitOptions(flags["unit"], flags["scale"], None, flags["weld"], sag).of_a()
    check = flags["check"]
    if flags["parts"]:
        if flags["overlaps_itself"]:
            fault = "asks about one mesh, and --parts lists the parts as they are"
            raise UsageError("--overlaps-itself", fault, "leave out one of the two")
        for name in ("unit", "scale", "weld"):
            if flags[name] is not None:
                fault = "changes one mesh, and --parts lists the parts as they are"
                raise UsageError(f"--{name}", fault, "leave out one of the two")
        return _parts(file, sag, common, check=check)
    start = time.perf_counter()
    stamp = stamp_of(file_of(file))
    shape, sha256 = read_shape(file, verify=not flags["no_verify"], sag=sag)
    shape = shape if lengths is None else lengths.measured(shape, file)
    if check:
        (ObbTree.build(shape) if isinstance(shape, Mesh) else shape).check()
    sha256 = sha256 or file_sha256(file_of(file), stamp)
    asked = flags["overlaps_itself"]
    record = info_record(file, shape, sha256, is_checked=check, looks_for_overlap=asked)
    record["stats"] = {"seconds": {"total": time.perf_counter() - start}}
    emit(record, info_tables, common)
    return 0


def _parts(file: str, sag: float | None, common: CommonOptions, *, check: bool) -> int:
    """List the parts of a mesh file."""
    from obbcli.report.parts import parts_bare, parts_record, parts_tables

    if check:
        raise UsageError("--parts", "lists parts, and --check proves a tree", "leave out one")
    start = time.perf_counter()
    record = parts_record(file, _assembly(file, sag))
    record["stats"] = {"seconds": {"total": time.perf_counter() - start}}
    emit(record, parts_tables, common, bare=parts_bare)
    return 0


def _assembly(file: str, sag: float | None) -> Assembly:
    """Return the parts of a mesh file, of what a pipe brings, or of standard input.

    Raises:
        MeshError: it cannot be read or is refused, or is a tree.
    """
    from obbcli.files import file_of
    from obbcli.mesh.parts.load import read_parts_bytes
    from obbcli.motion.assembly import assembly_of, load_parts
    from obbcli.tree.header import is_tree_file
    from obbcli.tree.tree import begins_as_tree

    piped = read_piped(file)
    if begins_as_tree(Path(file_of(file))) if piped is None else is_tree_file(piped.data):
        remedy = "ask about the mesh that it was built of"
        raise MeshError(file, "is a tree file, which has no parts", remedy)
    if piped is None:
        return load_parts(file, sag=sag)
    return assembly_of(read_parts_bytes(piped.data, piped.suffix, name=piped.place, sag=sag))
