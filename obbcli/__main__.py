"""Runs the command line as `python -m obbcli`."""

from __future__ import annotations

from obbcli.cli import run_process

if __name__ == "__main__":
    raise SystemExit(run_process())
