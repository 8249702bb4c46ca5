"""Python packages that some scripts need are Debian's, which only Debian's interpreter sees."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import subprocess
import sys

DEBIAN = pathlib.Path("/usr/bin/python3")
TRIED = "SGS_DEBIAN_PYTHON"  # in the environment of a script that was started again


def need(module: str, package: str) -> None:
    """Goes on where the module is; else starts the script again with Debian's interpreter. Raises
    ValueError where that has no such module either."""
    if importlib.util.find_spec(module):
        return
    if DEBIAN.exists() and not os.environ.get(TRIED):
        there = subprocess.run(
            [DEBIAN, "-c", f"import {module}"], stderr=subprocess.DEVNULL, check=False
        )
        if there.returncode == 0:
            sys.stdout.flush()
            os.execve(DEBIAN, [str(DEBIAN), "-B", *sys.argv], {**os.environ, TRIED: "1"})
    raise ValueError(f"needs {package}, which scripts/tools.sh installs")
