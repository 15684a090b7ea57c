"""Fixtures of the tests: surfaces, the folder of the repository, and the mesh corpus if it is there."""

import os
from pathlib import Path

import numpy as np
import pytest

import ricci

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def torus():
    return ricci.make("torus", a=2, b=0.8, n=40, m=20)


@pytest.fixture(scope="session")
def genus2():
    return ricci.make("genus", genus=2, n=4)


@pytest.fixture(scope="session")
def disk():
    return ricci.make("disk", n=12)


@pytest.fixture(scope="session")
def pants():
    """A sphere with three round holes."""
    return ricci.change(ricci.make("sphere", n=10), "punch", count=3)


@pytest.fixture(scope="session")
def corpus():
    """The files of the mesh corpus that are called good."""
    folder = Path(os.environ.get("RICCI_MESHES", ROOT.parent / "shared" / "meshes")) / "good"
    found = sorted(folder.glob("*.*"))
    found = [path for path in found if path.suffix in (".obj", ".off", ".ply", ".stl", ".glb", ".gii")]
    if not found:
        pytest.skip("the mesh corpus is absent: RICCI_MESHES names its folder")
    return found


def angle_defects(V_or_lengths, F, face_edges=None, boundary=()):
    """Curvature of every vertex of flat triangles, by the cosine law alone: an independent computation."""
    if face_edges is None:
        sides = [np.linalg.norm(V_or_lengths[F[:, (k + 1) % 3]] - V_or_lengths[F[:, (k + 2) % 3]], axis=1) for k in range(3)]
    else:
        sides = [V_or_lengths[np.abs(face_edges[:, k]) - 1] for k in range(3)]
    curvature = np.full(int(F.max()) + 1, 2 * np.pi)
    curvature[list(boundary)] = np.pi
    for k in range(3):
        a, b, c = sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]
        np.subtract.at(curvature, F[:, k], np.arccos(np.clip((b * b + c * c - a * a) / (2 * b * c), -1, 1)))
    return curvature
