"""Count the peers' box tests, which their Python faces do not tell.

A small library is loaded before theirs; its functions bear the names of their box tests, count the
calls and pass them on. That takes Linux and a C compiler; elsewhere there are no counts.
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Every argument of these functions is a reference, so that pointers stand for all of them.
SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
typedef _Bool (*Test)(void*, void*, void*, void*, void*, void*);
static long tests;
#define PASS_ON(symbol)                                                              \\
    static Test real_##symbol;                                                       \\
    _Bool symbol(void* a, void* b, void* c, void* d, void* e, void* f) {             \\
        ++tests;                                                                     \\
        return real_##symbol(a, b, c, d, e, f);                                      \\
    }                                                                                \\
    int bind_##symbol(const char* library) {                                         \\
        void* handle = dlopen(library, RTLD_NOW | RTLD_NOLOAD);                      \\
        real_##symbol = handle ? (Test)dlsym(handle, #symbol) : 0;                   \\
        return real_##symbol != 0;                                                   \\
    }
long take_count(void) { long n = tests; tests = 0; return n; }
"""
MATRIX = "N5Eigen6MatrixIdLi3ELi3ELi0ELi3ELi3EEE"
VECTOR = "NS1_IdLi3ELi1ELi0ELi3ELi1EEE"
SYMBOLS = {
    "python-fcl": (
        # fcl::obbDisjoint<double>, of a rotation and a translation, and of a transform
        "_ZN3fcl11obbDisjointIdEEbRKN5Eigen6MatrixIT_Li3ELi3ELi0ELi3ELi3EEE"
        "RKNS2_IS3_Li3ELi1ELi0ELi3ELi1EEES9_S9_",
        "_ZN3fcl11obbDisjointIdEEbRKN5Eigen9TransformIT_Li3ELi1ELi0EEE"
        "RKNS1_6MatrixIS3_Li3ELi1ELi0ELi3ELi1EEESA_",
    ),
    "coal": (
        # coal::overlap of two OBB under a rotation and a translation, with a request
        f"_ZN4coal7overlapERK{MATRIX}RK{VECTOR}RKNS_3OBBESA_RKNS_16CollisionRequestERd",
    ),
}
MODULES = {"python-fcl": "fcl", "coal": "coal"}


def count(triangles: int) -> dict[str, dict[str, int]]:
    """Return the box tests of a yes-or-no by pose class and peer; empty where none can be had."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None or not sys.platform.startswith("linux"):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        source, shim = Path(folder, "shim.c"), Path(folder, "shim.so")
        passed_on = (f"PASS_ON({symbol})\n" for names in SYMBOLS.values() for symbol in names)
        source.write_text(SHIM + "".join(passed_on))
        command = [compiler, "-O2", "-shared", "-fPIC", "-o", str(shim), str(source), "-ldl"]
        subprocess.run(command, check=True)
        done = subprocess.run(
            [sys.executable, __file__, str(shim), str(triangles)],
            env=os.environ | {"LD_PRELOAD": str(shim)},
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
    return {name: dict(counts) for name, counts in json.loads(done.stdout).items()}


def main(shim_path: str, triangles: int) -> None:
    """Count in a process that loaded the shim first, and print the counts as JSON."""
    from peers import Coal, Fcl
    from scenes.pairs import pairs

    shim = ctypes.CDLL(shim_path)
    counts: dict[str, dict[str, int]] = {}
    for one in (Fcl(), Coal()):
        built: dict[int, object] = {}
        bind(shim, one.name)
        for pair in pairs(triangles):
            for surface in (pair.a, pair.b):
                if id(surface) not in built:
                    built[id(surface)] = one.build(surface)
            query = one.query(built[id(pair.a)], built[id(pair.b)], pair)
            shim.take_count()
            query.collides()
            counts.setdefault(pair.name, {})[one.name] = int(shim.take_count())
    print(json.dumps(counts))


def bind(shim: ctypes.CDLL, peer: str) -> None:
    """Load a peer and point the shim to its functions."""
    importlib.import_module(MODULES[peer])
    maps = Path("/proc/self/maps").read_text().splitlines()
    paths = {line.split(maxsplit=5)[5] for line in maps if len(line.split(maxsplit=5)) == 6}
    library = next(
        path for path in sorted(paths) if Path(path).name.startswith(f"lib{MODULES[peer]}")
    )
    for symbol in SYMBOLS[peer]:
        assert getattr(shim, f"bind_{symbol}")(library.encode()), symbol


if __name__ == "__main__":
    sys.path.append(str(Path(__file__).resolve().parents[1]))
    main(sys.argv[1], int(sys.argv[2]))
