"""The sdist makes the same wheel: python sdist.py WHEEL FOLDER, by a Python with hatchling and cffi.

RICCI_LIBRARY names the library. Cargo, which makes it where none is named, is not on the path: the library is packed as it is, and the
licences are those that the sdist brings. Without a library the build says what it needs.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]


def built(folder):
    """The sdist, in this folder."""
    words = [sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder]
    subprocess.run(words, cwd=HERE, check=True, stdout=subprocess.DEVNULL)
    return next(folder.glob("ricci-*.tar.gz"))


def wheel_of(sdist, folder, environment):
    """What pip says of a wheel from it, without an index."""
    words = ["wheel", "--no-deps", "--no-index", "--no-build-isolation", "--disable-pip-version-check", "-w", folder, sdist]
    return subprocess.run([sys.executable, "-m", "pip", *words], env=environment, capture_output=True, text=True)


def content(wheel):
    """The files of a wheel but for the list of them and its tag, which manylinux changes."""
    with zipfile.ZipFile(wheel) as packed:
        return {name: packed.read(name) for name in packed.namelist() if not name.endswith(("/RECORD", "/WHEEL"))}


def main(wheel, folder):
    """Build and compare."""
    for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
        assert (HERE / licence).read_bytes() == (HERE.parent / licence).read_bytes(), f"python/{licence} is not that of the repository"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "bin").mkdir(parents=True)
    if strip := shutil.which("strip"):
        (folder / "bin" / "strip").symlink_to(strip)
    sdist = built(folder)
    with tarfile.open(sdist) as packed:
        members = packed.getmembers()
    assert all(member.isfile() for member in members), "the sdist has links"
    alone = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"} | {"PATH": str(folder / "bin")}
    made = wheel_of(sdist, folder, alone)
    assert made.returncode == 0, made.stderr
    theirs, ours = content(wheel), content(next(folder.glob("ricci-*.whl")))
    assert theirs.keys() == ours.keys(), theirs.keys() ^ ours.keys()
    assert [name for name in ours if ours[name] != theirs[name]] == []
    refused = wheel_of(sdist, folder / "none", {name: value for name, value in alone.items() if name != "RICCI_LIBRARY"})
    assert refused.returncode, "a wheel was made without a library"
    assert "install Rust 1.89 or later" in refused.stdout + refused.stderr, refused.stdout + refused.stderr
    print(f"{sdist.name}, {len(members)} files, {sdist.stat().st_size // 1024} KiB: the wheel from it is the same")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
