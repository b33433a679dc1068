"""A and B as they come, no trees built over meshes: for studies that build their own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.cli.boundary import UsageError
from obbcli.cli.inputs import STDIN, read_shape

if TYPE_CHECKING:
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.options.placement import UnitOptions
    from obbcli.mesh import Mesh
    from obbcli.report.record import Source
    from obbcli.tree.tree import ObbTree


def read_unbuilt(
    names: tuple[str, str], units: UnitOptions, common: CommonOptions, *, verify: bool
) -> tuple[tuple[Mesh | ObbTree, Mesh | ObbTree], tuple[Source, Source]]:
    """Return A and B, and what a record says of them.

    Args:
        names: as they were written.
        units: what becomes of their coordinates.
        common: how to answer.
        verify: whether a tree file's checksums are compared.

    Raises:
        UsageError: both are standard input.
        ObbError: one of them cannot be read.
        OSError: a file cannot be read.
    """
    from obbcli.cli.lengths import shared_sag
    from obbcli.files import file_of, stamp_of
    from obbcli.report.record import Source, file_sha256
    from obbcli.report.rows import about_units

    if names[0] == names[1] == STDIN:
        raise UsageError("B", "is standard input, and so is A", "name a file for one of them")
    found: dict[object, tuple[Mesh | ObbTree, Source]] = {}
    lengths = units.of_a(), units.of_b()
    own_a, own_b = shared_sag(names, lengths)
    keys = (names[0], own_a), (names[1], own_b)
    for key in keys:
        name, own = key
        if key in found:
            continue
        stamp = stamp_of(file_of(name))
        sag = None if own is None else own.sag
        shape, digest = read_shape(name, verify=verify, sag=sag)
        shape = shape if own is None else own.measured(shape, name)
        if digest is None and common.json:
            digest = file_sha256(file_of(name), stamp)
        source = Source.of(name, digest, shape)
        more = () if own is None else own.remarks
        found[key] = shape, source._replace(notes=(*source.notes, *more))
    (a, source_a), (b, source_b) = found[keys[0]], found[keys[1]]
    if common.quiet:
        return (a, b), (source_a, source_b)
    return (a, b), about_units((source_a, source_b), (a, b))
