"""Adds to the wheel the shared library, and the declarations of its headers for cffi.

The library is the one that RICCI_LIBRARY names, or that of the release build. A copy without its debug information goes beside the
package's files, so that the wheel needs neither a compiler nor a library path where it is installed.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

import cffi
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
# Headers with types come before those that include them.
HEADERS = (
    "ricci",
    "repair",
    "labels",
    "refine",
    "shapes",
    "homotopy",
    "charts",
    "uniformize",
    "deck",
    "circles",
    "seamless",
    "quads",
    "harmonic",
    "match",
    "structure",
    "spline",
    "surface_spline",
    "bicubic",
    "quad_spline",
)


def declarations(folder: Path) -> str:
    """The declarations of all headers in `folder`: without comments, preprocessor lines and inline functions."""
    text = "\n".join((folder / f"{name}.h").read_text(encoding="utf-8") for name in HEADERS)
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"^#(?:[^\n]*\\\n)*[^\n]*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"^static inline .*?^}", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r'extern "C" {|^}\s*$', "", text, flags=re.MULTILINE)
    text = re.sub(r"RICCI_(API(_VOID)?|EXPERIMENTAL)\b", "", text)
    return re.sub(r"\n\s*\n+", "\n", text)


def native_module(target: Path) -> None:
    """Write the declarations as the Python module `ricci._native`, which cffi reads without a C compiler."""
    ffi = cffi.FFI()
    ffi.cdef(declarations(HERE.parent / "include" / "ricci"))
    ffi.set_source("ricci._native", None)
    ffi.emit_python_code(str(target))


def shared_library() -> Path:
    """The library to be packed."""
    given = os.environ.get("RICCI_LIBRARY")
    folder = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parent / "target"))
    found = [Path(given)] if given else sorted((folder / "release").glob("libricci_c.[sd]*"))
    found = [path for path in found if path.suffix in (".so", ".dylib")]
    if not found or not found[0].exists():
        raise FileNotFoundError("no shared library: run `cargo build --release -p ricci-capi`, or set RICCI_LIBRARY")
    return found[0]


def licences(target: Path) -> None:
    """Write the licences of the crates that the library is linked from, as the C packages carry them; cargo knows them."""
    cargo = shutil.which("cargo")
    if cargo is None:
        raise FileNotFoundError("cargo is needed for the licences of the crates in the library")
    subprocess.run(
        [sys.executable, HERE.parent / "cmake" / "licences.py", cargo, HERE.parent, target], check=True, stdout=subprocess.DEVNULL
    )


class Hook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds both files to a wheel, whose tag says the platform but no version of Python."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before it packs the files; an editable installation (`version`) gets them in its tree."""
        package = HERE / "src" / "ricci"
        native_module(package / "_native.py")
        build_data["artifacts"].append("src/ricci/_native.py")
        if version == "editable":
            return
        source = shared_library()
        made = Path(self.directory) / f"libricci{source.suffix}"
        made.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, made)
        if strip := shutil.which("strip"):
            subprocess.run([strip, "--strip-unneeded" if source.suffix == ".so" else "-x", str(made)], check=True)
        build_data["force_include"][str(made)] = f"ricci/{made.name}"
        # The viewer of pages is that of the gallery.
        for name in ("view.html", "page.css", "picogl.min.js", "shape.js", "paint.js", "turn.js"):
            build_data["force_include"][str(HERE.parent / "apps" / "src" / "gallery" / name)] = f"ricci/viewer/{name}"
        licences(made.with_name("libricci.licences"))
        build_data["force_include"][str(made.with_name("libricci.licences"))] = "ricci/LICENSES-CRATES"
        for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
            build_data["force_include"][str(HERE.parent / licence)] = f"ricci/{licence}"
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Called when the wheel is there: the copy of the library has been packed."""
        for made in Path(self.directory).glob("libricci.*"):
            made.unlink()
