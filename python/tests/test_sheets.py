"""Strains of sheets, and darts."""

import numpy as np
import pytest

import ricci


def dome(n=10):
    disk = ricci.make("disk", n=n)
    return np.column_stack([disk.V[:, :2], -0.7 * (disk.V[:, :2] ** 2).sum(1)]), disk.F


def test_strains_are_those_of_the_singular_frames():
    V, F = dome()
    flat = ricci.flatten(V, F)
    sheet = ricci.strains(V, F, points=flat.points)
    p, q = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    plane = np.stack([flat.points[F[:, 1]] - flat.points[F[:, 0]], flat.points[F[:, 2]] - flat.points[F[:, 0]]], 2)
    threads = np.stack([p, q], 2) @ np.linalg.inv(plane)
    lengths = np.linalg.norm(threads, axis=1)
    np.testing.assert_allclose(sheet.warp, lengths[:, 0] - 1, atol=1e-12)
    np.testing.assert_allclose(sheet.weft, lengths[:, 1] - 1, atol=1e-12)
    cosine = (threads[:, :, 0] * threads[:, :, 1]).sum(1) / lengths.prod(1)
    np.testing.assert_allclose(np.sin(sheet.shear), cosine, atol=1e-12)
    with pytest.raises(ricci.RicciError, match="points"):
        ricci.strains(V, F, points=flat.points[:5])


def test_darts_bring_a_sheet_within_its_limits():
    V, F = dome()
    limits = {"strain_warp": 0.08, "strain_weft": 0.08}
    sheet = ricci.flatten_darts(V, F, **limits)
    assert sheet.summary.before > 1
    assert sheet.summary.after <= 1
    assert sheet.summary.n_darts > 0
    np.testing.assert_array_equal(sheet.mesh.V, V[sheet.origins])
    np.testing.assert_array_equal(sheet.origins[sheet.mesh.F], F)
    strained = ricci.strains(sheet.mesh, points=sheet.flat.points)
    assert max(np.abs(strained.warp).max(), np.abs(strained.weft).max()) <= 0.08
    assert ricci.flatten_darts(V, F, budget=1e-3, **limits).summary.n_darts == 0
    assert ricci.flatten_darts(V, F).summary.n_darts == 0
    with pytest.raises(ricci.ArgumentError, match="shear"):
        ricci.flatten_darts(V, F, shear=-1)
