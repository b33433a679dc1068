"""The scene of a command: a scene file, standard input, or a mesh file, which is its parts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from obbcli.cli.boundary import UsageError
from obbcli.cli.inputs import STDIN, read_stdin

if TYPE_CHECKING:
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.report.record import Source
    from obbcli.scene import Scene

    #: What the files of a scene's bodies were when it was read, by their paths.
    Stamps: TypeAlias = dict[str, tuple[int, ...] | None]

_STDIN_NAME = "<stdin>"


def read_scene(
    file: str,
    options: AccuracyOptions,
    duration: float | None,
    sag: float | None = None,
    *,
    verify: bool,
) -> tuple[Scene, Source, Stamps]:
    """Return the scene as asked about, its file, and what the files of its bodies are by now.

    Raises:
        UsageError: a sag is given for a scene, whose bodies have their own.
    """
    from obbcli.files import file_of, stamp_of
    from obbcli.mesh import digest_of
    from obbcli.report.record import Source
    from obbcli.scene import Scene
    from obbcli.scene.reader import parse_scene, read_bytes
    from obbcli.scene.scene import is_mesh_file

    if file != STDIN and is_mesh_file(file):
        return _read_parts(file, options, duration, sag)
    if sag is not None:
        fault = "cuts exact surfaces of a mesh file, and this is a scene"
        raise UsageError("--sag", fault, "write sag = D into its bodies")
    name = _STDIN_NAME if file == STDIN else file
    data = read_stdin() if file == STDIN else read_bytes(Path(file), name)
    folder = Path() if file == STDIN else Path(file).parent
    parts = parse_scene(data, name, folder, is_json=name.lower().endswith(".json"))
    paths = {str(body.body.shape) for body in parts.bodies}
    stamps = {path: stamp_of(file_of(path)) for path in paths}
    scene = Scene(
        parts.bodies,
        parts.ignore,
        parts.duration if duration is None else duration,
        options.accuracy(parts.accuracy),
        solid=parts.solid,
        verify=verify,
    )
    return scene, Source(file, digest_of(data)(), None), stamps


def _read_parts(
    file: str, options: AccuracyOptions, duration: float | None, sag: float | None
) -> tuple[Scene, Source, Stamps]:
    """Return the parts of a mesh file as a scene, as `_read`."""
    from obbcli.files import file_of, stamp_of
    from obbcli.motion.assembly import load_parts
    from obbcli.report.record import Source
    from obbcli.scene import Scene

    stamps = {file: stamp_of(file_of(file))}
    assembly = load_parts(file, sag=sag)
    scene = Scene(assembly, (), duration, options.accuracy())
    return scene, Source(file, assembly.sha256, None), stamps
