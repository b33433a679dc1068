"""The scene of a command: a scene file, standard input, or a mesh file, which is its parts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from obbcli.cli.boundary import UsageError
from obbcli.cli.inputs import STDIN, read_stdin

if TYPE_CHECKING:
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.mesh import Mesh
    from obbcli.report.record import Record, Source
    from obbcli.scene import Scene
    from obbcli.scene.pairs import ScenePairs
    from obbcli.scene.results import SceneStats
    from obbcli.tree.head import TreeHead
    from obbcli.tree.tree import ObbTree

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


def mesh_sources(
    source: Source, scene: Scene, asked: ScenePairs, stats: SceneStats, stamps: Stamps | None
) -> list[Source]:
    """Return what is said of the files of a scene's bodies, hashed where there are stamps.

    Raises:
        ObbError: a body's file is not what it was when the scene was read.
    """
    from obbcli.files import file_of
    from obbcli.report.record import Source, file_sha256
    from obbcli.report.rows import told_units
    from obbcli.report.scene import mesh_paths

    made: dict[str, list[Mesh | ObbTree | TreeHead]] = {}
    for body, shape in zip(asked.bodies, asked.shapes, strict=True):
        made.setdefault(str(body.body.shape), []).append(shape)
    meshes = []
    for path in mesh_paths(asked):
        digest = None if stamps is None else file_sha256(file_of(path), stamps[path])
        # A file may be taken in several units.
        notes = dict.fromkeys(note for shape in made[path] for note in shape.notes)
        meshes.append(Source.of(path, digest, made[path][0])._replace(notes=tuple(notes)))
    if not meshes:  # the parts of the scene's own file
        meshes = [_file_of_parts(source, scene, asked, stats)]
    return told_units(meshes)


def decoded(scene: Scene) -> Record:
    """Return how many meshes of a scene's own file were decoded; nothing of other scenes."""
    from obbcli.motion.lazy_mesh import LazyMesh

    shapes = {id(body.body.shape): body.body.shape for body in scene.bodies}
    parts = [shape for shape in shapes.values() if isinstance(shape, LazyMesh)]
    if not parts:
        return {}
    done = sum(shape.is_decoded for shape in parts)
    return {"meshes_decoded": done, "meshes_possible": len(parts)}


def _file_of_parts(source: Source, scene: Scene, asked: ScenePairs, stats: SceneStats) -> Source:
    """Return what is said of the mesh file that a scene's bodies are parts of.

    Its triangles are counted where all of it was asked about: what is not is not decoded.
    """
    is_whole = len(asked.bodies) == len(scene.bodies)
    counts = [body.triangle_count or 0 for body in stats.bodies]
    notes = dict.fromkeys(note for shape in asked.shapes for note in shape.notes)
    return source._replace(triangle_count=sum(counts) if is_whole else None, notes=tuple(notes))
