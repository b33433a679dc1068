"""Asks the same again and again, each time in another way: `python tests/determinism.py`.

A way is a number of threads, a kind of file (mesh, tree file, tree through a pipe), checksums
verified or not, a folder to start in and a seed of Python's hashes. Compared are the bytes of the
answers but for `inputs` and `stats`. One column more tells what an older processor would change.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import struct
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from determinism_questions import LARGE, PARTS, QUESTIONS, Question

if TYPE_CHECKING:
    from collections.abc import Sequence

SAMPLES = Path(__file__).resolve().parents[1] / "sample_meshes"
QUERIES = """id,omega_b,vel_b,translate_b
in step,0 0 -6,,
out of step,0 0 -5.9,,
pushed,,-1 0 0,5 0 0
lost,0 0,,
""" + "".join(f"row {i},0 0 {-5.5 - 0.01 * i:.2f},0 0 {0.5 * i},\n" for i in range(60))
LARGE_CELLS = 360  # 259,200 triangles: enough for seven threads to share the first boxes
# The command line as installed, but for the number of cores that it believes in.
COMMAND = """import sys
from obbcli import threads
from obbcli.cli import run_process
count = int(sys.argv.pop(1))
threads.usable_cores = lambda: count
sys.exit(run_process())
"""
# What the C library, BLAS and NumPy take a processor for: one without wide registers and fused
# operations, of which their sines and products of matrices make use.
OLDER = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable",
    "OPENBLAS_CORETYPE": "Nehalem",
    "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3 AVX512F AVX512_SKX AVX512_ICL X86_V3 X86_V4",
    "PYTHONWARNINGS": "ignore",
}


@dataclass(frozen=True)
class Way:
    """How a question is asked; nothing of it may show in the answer."""

    threads: int = 1
    seed: int = 0
    trees: tuple[bool, bool] = (False, False)
    piped: bool = False
    verify: bool = True
    elsewhere: bool = False
    is_older: bool = False  # of all this alone may change last digits


def ways(runs: int) -> list[Way]:
    """Return as many ways as asked for, of which the first is the plain one."""
    kinds = [(False, False), (True, True), (False, True), (True, False)]
    return [
        Way(
            threads=(1, 2, 7)[run % 3],
            seed=run,
            trees=kinds[run % 4],
            piped=run % 5 == 3,
            verify=run // 4 % 2 == 0,
            elsewhere=run // 3 % 2 == 1,
        )
        for run in range(runs)
    ]


class Bench:
    """A folder with meshes, their trees, a scene and rows, in which questions are asked."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "deeper").mkdir()
        (folder / "out").mkdir()
        (folder / "queries.csv").write_text(QUERIES)
        for name, file in PARTS.items():
            (folder / file).symlink_to(SAMPLES / file)
            self._run(Way(), "build", file, "-o", f"{name}.obbt")
        scene = (SAMPLES / "cell.toml").read_text().replace('mesh = "', f'mesh = "{SAMPLES}/')
        (folder / "meshes.toml").write_text(scene)
        for name, file in PARTS.items():
            scene = scene.replace(f"{SAMPLES}/{file}", f"{name}.obbt")
        (folder / "trees.toml").write_text(scene)

    def add_large(self) -> None:
        """Write a mesh of which several threads make the first boxes."""
        import numpy as np
        from meshes.nasty import bumpy_grid

        vertices, triangles = bumpy_grid(LARGE_CELLS)
        fields = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]
        records = np.zeros(len(triangles), dtype=fields)
        records["corners"] = vertices[triangles]
        head = bytes(80) + struct.pack("<I", len(records))
        (self.folder / LARGE).write_bytes(head + records.tobytes())

    def answer(self, question: Question, way: Way) -> bytes:
        """Return what is to be the same, whatever the way."""
        up = ".." if way.elsewhere else "."
        names = {name: f"{up}/{file}" for name, file in {**PARTS, "large": LARGE}.items()}
        data = b""
        for part, is_tree in zip(question.parts, way.trees, strict=False):
            if is_tree and question.takes and question.arguments[0] != "info":
                names[part] = f"{up}/{part}.obbt"
        if way.piped and "piped" in question.takes:
            data = (self.folder / f"{question.parts[0]}.obbt").read_bytes()
            names[question.parts[0]] = "-"
        names["tree"] = f"{up}/gear.obbt"
        names["scene"] = f"{up}/{'trees' if way.trees[0] else 'meshes'}.toml"
        names["queries"] = f"{up}/queries.csv"
        names["out"] = f"{up}/out/{question.file or 'gear.obbt'}"
        arguments = [argument.format(**names) for argument in question.arguments]
        if not way.verify and "verify" in question.takes:
            arguments.append("--no-verify")
        printed = self._run(way, *arguments, "--json", data=data)
        written = (self.folder / "out" / question.file).read_bytes() if question.file else printed
        if question.file and not question.file.endswith(".jsonl"):
            return written
        return b"\n".join(_essence(line, question) for line in written.splitlines())

    def _run(self, way: Way, *arguments: str, data: bytes = b"") -> bytes:
        child = subprocess.run(
            [sys.executable, "-c", COMMAND, str(way.threads), *arguments],
            cwd=self.folder / "deeper" if way.elsewhere else self.folder,
            env={**os.environ, **(OLDER if way.is_older else {}), "PYTHONHASHSEED": str(way.seed)},
            input=data,
            capture_output=True,
            check=False,
        )
        # 3: a row of the sweep is refused on purpose.
        if child.returncode not in ((0, 3) if arguments[0] == "sweep" else (0,)):
            raise RuntimeError(f"{' '.join(arguments)}: {child.stderr.decode()}")
        return child.stdout


def _essence(line: bytes, question: Question) -> bytes:
    """Return a document as bytes without inputs and stats; every digit stays as it was printed."""
    document = json.loads(line, parse_float=str, parse_int=str)
    for key in ("inputs", "stats", "digest"):  # the digest is over the inputs
        document.pop(key, None)
    if question.arguments[0] == "build":
        for file in document["result"]["files"]:
            del file["output"]  # where it went, which was asked for
    if "error" in document:
        del document["error"]["where"]  # the path of the input
    kept = document if question.forgets is None else question.forgets(document)
    return json.dumps(kept).encode()


def difference(one: bytes, other: bytes) -> str:
    """Return by how much the numbers of two answers differ at most, relative to the larger."""
    if one == other:
        return "same"
    pattern = rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?"
    if re.sub(pattern, b"", one) != re.sub(pattern, b"", other):
        return "other words"
    pairs = zip(re.findall(pattern, one), re.findall(pattern, other), strict=True)
    numbers = [(float(x), float(y)) for x, y in pairs if x != y]
    return f"{max(abs(x - y) / max(abs(x), abs(y)) for x, y in numbers):.0e}"


def report(names: Sequence[str], folder: Path, runs: int) -> int:
    """Ask, print a table, and return how many questions were not answered alike."""
    bench = Bench(folder)
    bench.add_large()
    differing = 0
    sys.stdout.write(
        f"{'question':32}{'ways':>5}{'bytes':>10}{'answers':>9}{'s':>7}{'older':>12}\n"
    )
    for name in names:
        question, start = QUESTIONS[name], time.perf_counter()
        asked = ways(min(runs, 4) if question.is_slow else runs)
        answers = Counter(bench.answer(question, way) for way in asked)
        usual = answers.most_common(1)[0][0]
        differing += len(answers) > 1
        older = difference(
            bench.answer(question, Way()), bench.answer(question, Way(is_older=True))
        )
        sys.stdout.write(
            f"{name:32}{len(asked):>5}{len(usual):>10,}{len(answers):>9}"
            f"{time.perf_counter() - start:>7.1f}{older:>12}\n"
        )
        sys.stdout.flush()
    return differing


def main() -> None:
    """Ask what is asked for, and fail where answers differ."""
    import tempfile

    parser = argparse.ArgumentParser(description="the same questions in many ways")
    parser.add_argument("--runs", type=int, default=20, help="ways a question (studies: 4)")
    parser.add_argument("--only", choices=QUESTIONS, action="append", help="one question")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        differing = report(given.only or list(QUESTIONS), Path(folder), given.runs)
    if differing:
        sys.exit(f"{differing} questions were answered in more than one way")
    sys.stdout.write("every question was answered alike in all ways\n")


if __name__ == "__main__":
    main()
