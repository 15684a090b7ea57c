"""Loads the shared library, and checks that it has the version that this package was made for."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from ricci._native import ffi

__all__ = ["ffi", "lib", "path"]

# The version of the headers, whose macros cffi does not read: ricci.h, RICCI_VERSION_*.
MAJOR, MINOR = 0, 1
# Linux is tested; the others are written, and were not run.
SUFFIX = {"darwin": ".dylib", "win32": ".dll"}.get(sys.platform, ".so")


def _find() -> Path:
    """The library that RICCI_LIBRARY names, else the one beside this file."""
    given = os.environ.get("RICCI_LIBRARY")
    found = Path(given) if given else Path(__file__).resolve().parent / f"libricci{SUFFIX}"
    if not found.exists():
        origin = "RICCI_LIBRARY names" if given else "this package looks for"
        raise ImportError(f"the shared library that {origin}, {found}, does not exist")
    return found


class Library:
    """The functions and constants of the shared library by their names.

    It is pickled as the name of `lib` in this module, so that functions whose globals have it can be sent to other processes by value.
    """

    def __init__(self, opened: Any) -> None:
        self._opened = opened

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._opened, name)
        self.__dict__[name] = value
        return value

    def __dir__(self) -> list[str]:
        return dir(self._opened)

    def __reduce__(self) -> str:
        return "lib"


def _open(found: Path) -> Any:
    """The library as cffi's object; an ImportError if it has another binary interface than the headers."""
    opened = ffi.dlopen(str(found))
    number = opened.ricci_version_number()
    major, minor = number // 1_000_000, number // 1_000 % 1_000
    if (major, minor) != (MAJOR, MINOR):
        raise ImportError(f"{found} is version {major}.{minor}, this package is made for {MAJOR}.{MINOR}")
    return opened


path: Path = _find()
lib: Any = Library(_open(path))
VERSION: str = ffi.string(lib.ricci_version()).decode()
