"""Shows that a wheel works where there is no compiler: `bare_install.py WHEEL FOLDER_OF_WHEELS`.

It is installed from files alone, and asked with nothing but its own environment on the path.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import zipfile
from io import BytesIO
from pathlib import Path

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
# Parts of the C library, which every Python needs as well.
C_LIBRARY = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1"}
LOADERS = ("ld-linux", "ld64", "linux-vdso")


def libraries(wheel: Path) -> dict[str, set[str]]:
    """Return the shared libraries that each shared object in a wheel asks the loader for."""
    from elftools.elf.elffile import ELFFile

    needed = {}
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            if name.endswith(".so"):
                dynamic = ELFFile(BytesIO(archive.read(name))).get_section_by_name(".dynamic")
                tags = dynamic.iter_tags("DT_NEEDED")
                needed[name] = {tag.needed for tag in tags if not tag.needed.startswith(LOADERS)}
    return needed


def ask(environment: Path) -> dict[str, object]:
    """Return what the installed command says of two gears pushed together; it has its manual."""
    gears = [
        str(SAMPLES / "gear.stl"),
        str(SAMPLES / "pinion.stl"),
        "--translate-b",
        "-1",
        "0",
        "0",
    ]
    command = [str(environment / "bin" / "obbtree"), "collide", *gears, "--json"]
    bare = {"PATH": str(environment / "bin")}
    with tempfile.TemporaryDirectory() as elsewhere:
        child = subprocess.run(
            command, cwd=elsewhere, env=bare, check=True, capture_output=True, text=True
        )
        manual = [command[0], "manual", "tour"]
        shown = subprocess.run(
            manual, cwd=elsewhere, env=bare, check=True, capture_output=True, text=True
        )
    if not shown.stdout.startswith("# A tour"):
        sys.exit("the manual is not in the wheel")
    result: dict[str, object] = json.loads(child.stdout)["result"]
    return result


def main() -> None:
    """Install, ask, and print what was found; end with a fault where something is amiss."""
    wheel, folder = Path(sys.argv[1]), sys.argv[2]
    if sys.platform == "linux":
        beyond = {name: needed - C_LIBRARY for name, needed in libraries(wheel).items()}
        if not beyond or any(beyond.values()):
            sys.exit(f"{wheel.name}: needs libraries of the system: {beyond}")
    with tempfile.TemporaryDirectory() as temporary:
        environment = Path(temporary) / "venv"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
        subprocess.run(
            [sys.executable, "-m", "pip", "-q", "--python", environment / "bin" / "python",
             "install", "--no-index", "--find-links", folder, wheel],
            check=True,
            env={**os.environ, "PIP_NO_INDEX": "1", "PATH": str(environment / "bin")},
        )  # fmt: skip
        result = ask(environment)
    if result["status"] != "overlap_at_start":
        sys.exit(f"{wheel.name}: said {result}")
    sys.stdout.write(
        f"{wheel.name}: {wheel.stat().st_size:,} bytes, needs the C library alone, "
        "installs and answers without a compiler\n"
    )


if __name__ == "__main__":
    main()
