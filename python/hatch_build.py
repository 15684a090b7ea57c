"""Adds to the wheel the shared library, and the declarations of its headers for cffi; to an sdist the sources of the library.

The library is the one that RICCI_LIBRARY names, or that of the release build, which an sdist makes by cargo. A copy without its debug
information goes beside the package's files, so that the wheel needs neither a compiler nor a library path where it is installed.
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
# An sdist has the sources of the library in a folder of its own.
UNPACKED = HERE / "library"
ROOT = UNPACKED if UNPACKED.is_dir() else HERE.parent
# What cargo reads to build the C face: also what Cargo.toml names and does not build; and the viewer, the headers and the licences.
SOURCES = (
    *("Cargo.toml", "Cargo.lock", "README.md", "LICENSE-MIT", "LICENSE-APACHE"),
    *("src", "capi", "apps", "benches", "include", "cmake/licences.py", "tests/mesh_memory.rs"),
)
# Headers with types come before those that include them.
HEADERS = (
    "ricci",
    "repair",
    "labels",
    "refine",
    "shapes",
    "texture",
    "scene",
    "homotopy",
    "charts",
    "uniformize",
    "deck",
    "circles",
    "flatten",
    "seamless",
    "quads",
    "freesurfer",
    "gifti",
    "harmonic",
    "match",
    "moduli",
    "structure",
    "spline",
    "surface_spline",
    "bicubic",
    "quad_spline",
    "control_mesh",
    "archive",
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
    ffi.cdef(declarations(ROOT / "include" / "ricci"))
    ffi.set_source("ricci._native", None)
    ffi.emit_python_code(str(target))


def build_library() -> None:
    """Build the library of an unpacked sdist, which takes minutes."""
    cargo = shutil.which("cargo")
    if cargo is None:
        raise FileNotFoundError(
            "the library of ricci is built by cargo, which is not on the path: install Rust 1.89 or later (https://rustup.rs), "
            "take a wheel, or name a built library by RICCI_LIBRARY"
        )
    subprocess.run([cargo, "build", "--release", "--locked", "--package", "ricci-capi", "--lib"], cwd=ROOT, check=True)


def shared_library() -> Path:
    """The library to be packed."""
    given = os.environ.get("RICCI_LIBRARY")
    if not given and ROOT == UNPACKED:
        build_library()
    folder = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    found = [Path(given)] if given else [folder / "release" / name for name in ("libricci_c.so", "libricci_c.dylib", "ricci_c.dll")]
    found = [path for path in found if path.suffix in (".so", ".dylib", ".dll") and path.exists()]
    if not found:
        raise FileNotFoundError("no shared library: run `cargo build --release -p ricci-capi`, or set RICCI_LIBRARY")
    return found[0]


def licences(target: Path) -> None:
    """Write the licences of the crates that the library is linked from, as the C packages carry them.

    Cargo knows them. Where it is absent an sdist has those of the machine that it was made on.
    """
    cargo, kept = shutil.which("cargo"), UNPACKED / "LICENSES-CRATES"
    if cargo is not None:
        subprocess.run([sys.executable, ROOT / "cmake" / "licences.py", cargo, ROOT, target], check=True, stdout=subprocess.DEVNULL)
    elif kept.exists():
        shutil.copyfile(kept, target)
    else:
        raise FileNotFoundError("cargo is needed for the licences of the crates in the library")


class Hook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds both files to a wheel, whose tag says the platform but no version of Python; to an sdist the sources."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before it packs the files."""
        if self.target_name == "sdist":
            self._source(build_data)
        else:
            self._binary(version, build_data)

    def _source(self, build_data: dict[str, Any]) -> None:
        """Add the sources of the library, unless this is an sdist, which has them."""
        if ROOT == UNPACKED:
            return
        for name in SOURCES:
            build_data["force_include"][str(ROOT / name)] = f"library/{name}"
        made = Path(self.directory) / "libricci.licences"
        made.parent.mkdir(parents=True, exist_ok=True)
        licences(made)
        build_data["force_include"][str(made)] = "library/LICENSES-CRATES"

    def _binary(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the library and its declarations; an editable installation (`version`) gets them in its tree."""
        package = HERE / "src" / "ricci"
        native_module(package / "_native.py")
        build_data["artifacts"].append("src/ricci/_native.py")
        if version == "editable":
            return
        source = shared_library()
        made = Path(self.directory) / f"libricci{source.suffix}"
        made.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, made)
        if source.suffix != ".dll" and (strip := shutil.which("strip")):
            subprocess.run([strip, "--strip-unneeded" if source.suffix == ".so" else "-x", str(made)], check=True)
        build_data["force_include"][str(made)] = f"ricci/{made.name}"
        # The viewer of pages is that of the gallery.
        for name in ("view.html", "page.css", "picogl.min.js", "shape.js", "paint.js", "turn.js"):
            build_data["force_include"][str(ROOT / "apps" / "src" / "gallery" / name)] = f"ricci/viewer/{name}"
        licences(made.with_name("libricci.licences"))
        build_data["force_include"][str(made.with_name("libricci.licences"))] = "ricci/LICENSES-CRATES"
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Called when the wheel is there: the copy of the library has been packed."""
        for made in Path(self.directory).glob("libricci.*"):
            made.unlink()
