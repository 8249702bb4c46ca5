"""Figures beside the tables that a script has written, by a script of their own, which may need
another Python."""

from __future__ import annotations

import pathlib
import subprocess
import sys

SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "figures.py"


def draw_beside(tables: pathlib.Path, *names: str) -> None:
    """Those of these figures that the folder's tables have something for. Where there are none, or
    no Matplotlib, a line says why: the tables are what counts. No figure of earlier tables stays
    beside them."""
    for name in names:
        for suffix in ("svg", "png"):
            (tables / f"{name}.{suffix}").unlink(missing_ok=True)
    words = [sys.executable, "-B", str(SCRIPT), *names, "--from", str(tables), "--out", str(tables)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"no figure: {(done.stdout or done.stderr).splitlines()[0]}", file=sys.stderr)
