"""`obbtree build`: keep the trees of meshes in files."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from obbcli.cli.boundary import UsageError, as_error, report, writing
from obbcli.cli.inputs import STDIN, keep_inputs, read_shape
from obbcli.cli.options.option import Command, common_options, gathered, option
from obbcli.cli.options.placement import (
    UnitOptions,
    sag_option,
    scale_option,
    unit_option,
    weld_option,
)
from obbcli.cli.options.words import PathName, Whole, byte_count
from obbcli.cli.output import emit, remark, require_free
from obbcli.cli.progress import bar
from obbcli.errors import MeshError, ObbError
from obbcli.files import file_and_pattern
from obbcli.tree.options import DEFAULT_BUILD, FITS, SPLITS, BuildOptions

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.cli.options.option import CommonOptions
    from obbcli.mesh import Mesh
    from obbcli.report.build import Built
    from obbcli.tree.options import Fit, Split

SUFFIX = ".obbt"


class TreeOptions(NamedTuple):
    """How trees are built, and whether files may be replaced."""

    fit: Fit
    split: Split
    leaf_size: int
    max_depth: int | None
    max_memory: int | None
    force: bool
    unit: str | None
    scale: float | None
    weld: float | None
    sag: float | None

    @property
    def build(self) -> BuildOptions:
        """Return what shapes the trees."""
        return BuildOptions(self.fit, self.split, self.leaf_size, self.max_depth)


def _listed(ways: Iterable[str]) -> str:
    """Return ways as help lists them."""
    *some, last = ways
    return f"{', '.join(some)}, or {last}"


_TREE = "Tree"
build_options = gathered(
    "how",
    TreeOptions,
    (
        option(
            _TREE,
            "--fit",
            type=click.Choice(tuple(FITS)),
            default=DEFAULT_BUILD.fit,
            show_default=True,
            help=f"Orient boxes {_listed(FITS.values())}.",
        ),
        option(
            _TREE,
            "--split",
            type=click.Choice(tuple(SPLITS)),
            default=DEFAULT_BUILD.split,
            show_default=True,
            help=f"Part boxes {_listed(SPLITS.values())}.",
        ),
        option(
            _TREE,
            "--leaf-size",
            type=Whole(1),
            default=DEFAULT_BUILD.leaf_size,
            show_default=True,
            metavar="N",
            help="Do not split a box of N triangles.",
        ),
        option(
            _TREE,
            "--max-depth",
            type=Whole(0),
            metavar="N",
            help="Do not split boxes at level N, the root being 0 [default: no limit].",
        ),
        option(
            _TREE,
            "--max-memory",
            callback=byte_count,
            metavar="BYTES",
            help="Refuse a mesh whose build needs more bytes, such as 500M [default: no limit].",
        ),
        option(_TREE, "--force", is_flag=True, help="Replace tree files that exist."),
        unit_option,
        scale_option("--scale", "the mesh's"),
        weld_option,
        sag_option,
    ),
)


@click.command(
    "build",
    cls=Command,
    short_help="Keep the trees of meshes in .obbt files.",
    epilog="""\b
Examples:
  obbtree build gear.stl                    writes gear.obbt beside it
  obbtree build *.stl -o trees/ --force
  obbtree build scan.ply --leaf-size 4 -o coarse.obbt
""",
)
@click.argument("meshes", metavar="MESH...", nargs=-1, required=True, type=PathName())
@build_options
@common_options(
    "Write the tree to FILE, or the trees into DIR [default: beside each mesh].",
    metavar="FILE|DIR",
    takes_dash=False,
)
def command(meshes: tuple[str, ...], how: TreeOptions, common: CommonOptions) -> int:
    """Build trees over meshes and keep them: gear.stl becomes gear.obbt.

    A tree file holds everything that questions need. A mesh that cannot be read is reported, and
    the others are built all the same.
    """
    from obbcli.report.build import build_record, build_tables

    files: list[Built | ObbError] = []
    code = 0
    targets = _targets(meshes, common.output)
    for _, target in targets:
        keep_inputs(target, meshes)
    for name, target in targets:
        try:
            files.append(_build(name, target, how, common))
        except (ObbError, OSError, MemoryError) as fault:
            files.append(as_error(fault))
            code = max(code, report(as_error(fault), as_json=common.json))
    failed = sum(isinstance(file, ObbError) for file in files)
    if common.json or failed < len(files):
        record = build_record(meshes, files, how.build._asdict())
        emit(record, build_tables, common._replace(output=None), bare=lambda _: "")
    if len(meshes) > 1 and failed:
        verb = "was" if failed == 1 else "were"
        remark(f"{failed} of {len(meshes)} trees {verb} not built", common)
    return code


def _targets(meshes: tuple[str, ...], output: Path | None) -> list[tuple[str, Path]]:
    """Return where each tree goes.

    Raises:
        UsageError: two trees would go to one place, or a place is missing.
    """
    if output is None and STDIN in meshes:
        raise UsageError(STDIN, "standard input has no name to call its tree by", "add -o FILE")
    selected = [name for name in meshes if file_and_pattern(name)[1] is not None]
    if selected and (output is None or output.is_dir()):
        fault = "selects parts of a file, which name no tree"
        raise UsageError(selected[0], fault, "build one selection, and add -o FILE")
    if output is not None and not output.is_dir():
        if len(meshes) > 1:
            raise UsageError(f"-o {output}", "is not a directory", "create it, or build one mesh")
        return [(meshes[0], output)]
    targets = [
        (output or Path(name).parent) / f"{'stdin' if name == STDIN else Path(name).stem}{SUFFIX}"
        for name in meshes
    ]
    place, uses = Counter(targets).most_common(1)[0]
    if uses > 1:
        raise UsageError(str(place), f"would hold {uses} trees", "build them one by one with -o")
    return list(zip(meshes, targets, strict=True))


def _build(name: str, target: Path, how: TreeOptions, common: CommonOptions) -> Built:
    """Build and save one tree."""
    from obbcli.report.build import Built
    from obbcli.tree.tree import ObbTree

    require_free(target, force=how.force)
    start = time.perf_counter()
    mesh = _mesh(name, how)
    loaded = time.perf_counter()
    with bar(f"building {name}", len(mesh.triangles), wanted=common.shows_progress) as move:
        options, limit = how.build._asdict(), how.max_memory
        try:
            tree = ObbTree.build(mesh, **options, lazy=False, max_memory=limit, progress=move)
        except MeshError as fault:
            # The mesh knows its file's name alone, and two folders may hold the same.
            raise MeshError(name, fault.fault, fault.remedy) from fault
    ready = time.perf_counter()
    with writing(target):
        size = tree.save(target)
    saved = time.perf_counter()
    seconds = {"load": loaded - start, "build": ready - loaded, "save": saved - ready}
    return Built(tree, str(target), size, seconds)


def _mesh(name: str, how: TreeOptions) -> Mesh:
    from obbcli.mesh import Mesh

    lengths = UnitOptions(how.unit, how.scale, None, how.weld, how.sag).of_a()
    shape, _ = read_shape(name, verify=True, sag=how.sag)
    if not isinstance(shape, Mesh):
        raise MeshError(name, "is a tree file already", "build from the mesh it was made of")
    made = shape if lengths is None else lengths.measured(shape, name)
    assert isinstance(made, Mesh)
    return made
