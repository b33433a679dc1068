"""What commands do with files of every format, seen by an audit hook: they are read, and no more.

The hook sees what libraries do as well; `test_safety` reads our own source.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from mesh_files.cell_files import VOLUME_KINDS, write
from mesh_files.collada_files import COLLADA_SEEDS
from mesh_files.deck_files import DECKS
from mesh_files.gltf_documents import draco_square, meshopt_square, with_fallback
from mesh_files.nastran_decks import TETRA
from mesh_files.threemf_files import THREEMF_SEEDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from mesh_files.gltf_files import Builder

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"

# Runs commands and prints what each did that an audit hook sees, after its own output.
WATCHED = """import json, sys
events = []
def watch(event, arguments):
    events.append((event, [str(argument) for argument in arguments[:3]]))
from obbcli.cli import main
sys.addaudithook(watch)
for words in json.loads(sys.argv[1]):
    code = main(words)
    print("\\n#" + json.dumps([code, list(events)]))
    events.clear()
"""
UNSAFE_EVENTS = {
    *("socket", "subprocess", "pickle", "urllib", "http", "ftplib", "smtplib", "webbrowser", "pty"),
    *("os.system", "os.exec", "os.fork", "os.forkpty", "os.posix_spawn", "os.spawn", "os.remove"),
    *("builtins.input", "code.__new__", "os.chmod", "os.link", "os.symlink", "shutil"),
}
WRITING = os.O_WRONLY | os.O_RDWR


class Watched(NamedTuple):
    """What a command did: its unsafe events, and the paths that it opened to be written to."""

    code: int
    unsafe: set[str]
    written: set[str]


def watched(folder: Path, *commands: tuple[str, ...]) -> list[Watched]:
    """Return what each of some commands does, one after another in one interpreter."""
    child = subprocess.run(
        [sys.executable, "-B", "-c", WATCHED, json.dumps(commands)],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    lines = [line[1:] for line in child.stdout.splitlines() if line.startswith("#[")]
    assert len(lines) == len(commands), child.stderr
    return [told(*json.loads(line)) for line in lines]


def told(code: int, events: list[tuple[str, list[str]]]) -> Watched:
    """Return what the events of a command say."""
    unsafe = {name for name, _ in events if {name, name.partition(".")[0]} & UNSAFE_EVENTS}
    opened = [about for name, about in events if name == "open"]
    assert opened  # the watch saw the command read its file
    return Watched(code, unsafe, {path for path, _, flags in opened if int(flags) & WRITING})


INNOCENT = Watched(0, set(), set())


MOVED = ("chain_link_a.off", "chain_link_b.ply", "--vel", "0", "0", "-5")


QUESTIONS = (
    ("info", "gear.stl", "--check"),
    ("collide", "gear.stl", "pinion.stl", "--all-pairs"),
    ("first-contact", *MOVED, "--all-contacts"),
    ("distance", "bolt.ply", "nut.obj"),
    ("scene", "cell.toml"),
    ("stability", *MOVED),
    ("tradeoff", *MOVED, "--budget", "0.5"),
)


def test_questions_read_files_and_do_nothing_else() -> None:
    *found, studied = watched(SAMPLES, *QUESTIONS)

    assert found == [INNOCENT] * len(found)
    # On a busy machine the budget may end before the first answer is there.
    assert studied in (INNOCENT, INNOCENT._replace(code=4))


def test_a_sweep_writes_its_results_alone(tmp_path: Path) -> None:
    (tmp_path / "q.csv").write_text("vel\n0 0 -5\n")
    meshes = [str(SAMPLES / name) for name in MOVED[:2]]

    (found,) = watched(tmp_path, ("sweep", *meshes, "q.csv", "-o", "r.jsonl"))

    assert found == INNOCENT._replace(written={"r.jsonl"})


def test_a_build_writes_beside_the_tree_and_renames(tmp_path: Path) -> None:
    (found,) = watched(tmp_path, ("build", str(SAMPLES / "nut.obj"), "-o", "nut.obbt"))

    assert found.code == 0
    assert not found.unsafe - {"os.chmod"}
    assert {(tmp_path / path).parent for path in found.written} == {tmp_path}
    assert [path.name for path in tmp_path.iterdir()] == ["nut.obbt"]


def test_libraries_read_a_mesh_and_do_nothing_else(tmp_path: Path) -> None:
    kinds = dict(VOLUME_KINDS)
    names = sorted(kinds)
    for name in names:
        write(tmp_path / name, [("tetra", np.array([[0, 1, 2, 5], [0, 2, 3, 7]]))], **kinds[name])

    found = watched(tmp_path, *(("info", name) for name in names))

    assert dict(zip(names, found, strict=True)) == dict.fromkeys(names, INNOCENT)


@pytest.mark.parametrize(
    "made",
    [
        pytest.param(draco_square, marks=pytest.mark.needs("DracoPy")),
        pytest.param(meshopt_square, marks=pytest.mark.needs("meshopt")),
    ],
)
def test_codecs_unpack_a_mesh_and_do_nothing_else(
    made: Callable[[], Builder], tmp_path: Path
) -> None:
    (tmp_path / "packed.glb").write_bytes(with_fallback(made()))

    assert watched(tmp_path, ("info", "packed.glb")) == [INNOCENT]


def test_scenes_of_xml_are_read_and_nothing_else_is_done(tmp_path: Path) -> None:
    files = {
        **{f"{number}.3mf": data for number, data in enumerate(THREEMF_SEEDS)},
        **{f"{number}.dae": data for number, data in enumerate(COLLADA_SEEDS)},
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)

    found = watched(tmp_path, *(("info", name) for name in files))

    assert dict(zip(files, found, strict=True)) == dict.fromkeys(files, INNOCENT)


@pytest.mark.needs("vtk")
def test_vtk_reads_a_mesh_and_does_nothing_else(tmp_path: Path) -> None:
    from mesh_files import vtk_files

    names = []
    for number, make in enumerate(vtk_files.DATA_SETS.values()):
        (folder := tmp_path / str(number)).mkdir()
        names.append(vtk_files.write_xml(folder, make(), "appended", "zlib"))
        names.append(vtk_files.write_legacy(folder / "a.vtk", make(), True, 51))
    names.append(tmp_path / "a.vtm")
    names[-1].write_text(
        '<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet>'
        '<DataSet index="0" file="0/a.vtu"/></vtkMultiBlockDataSet></VTKFile>'
    )

    found = watched(tmp_path, *(("info", str(name)) for name in names))

    assert dict(zip(names, found, strict=True)) == dict.fromkeys(names, INNOCENT)


def test_ear_clipping_reads_a_mesh_and_does_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 2 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 2 3 4 1\n")

    assert watched(tmp_path, ("info", "a.obj")) == [INNOCENT]


def test_our_readers_of_decks_read_a_mesh_and_do_nothing_else(tmp_path: Path) -> None:
    names = [f"{number}{suffix}" for number, (suffix, _) in enumerate(DECKS)]
    for name, (_, data) in zip(names, DECKS, strict=True):
        (tmp_path / name).write_bytes(data)
    (tmp_path / "including.inp").write_text(f"*INCLUDE, INPUT={names[0]}\n")
    names.append("including.inp")

    found = watched(tmp_path, *(("info", name) for name in names))

    assert dict(zip(names, found, strict=True)) == dict.fromkeys(names, INNOCENT)


def test_a_deck_that_includes_files_reads_them_and_does_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "part.inc").write_text(TETRA + "CORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n")
    (tmp_path / "main.bdf").write_text("BEGIN BULK\nINCLUDE 'part.inc'\nENDDATA\n")

    assert watched(tmp_path, ("info", "main.bdf")) == [INNOCENT]


def test_the_watch_sees_what_it_is_for(tmp_path: Path) -> None:
    code = (
        "import pickle, socket; socket.socket(); open('x', 'w'); pickle.loads(b'cos\\nsystem\\n.')"
    )
    spy = WATCHED.replace("main(words)", "exec(words) or 0")

    child = subprocess.run(
        [sys.executable, "-c", spy, json.dumps([code])],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )

    names = {name for name, _ in json.loads(child.stdout.rpartition("\n#")[2])[1]}
    assert {"socket.__new__", "pickle.find_class", "open"} <= names
