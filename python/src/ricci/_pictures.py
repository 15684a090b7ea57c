"""Small pictures of surfaces and layouts, drawn with numpy alone: what a notebook shows of an object."""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Mapping
from html import escape
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Scene", "drawn", "html", "png"]

Array = npt.NDArray[np.float64]


class Scene(NamedTuple):
    """What there is to be seen of an object: triangles in the plane or in space, and their colours."""

    #: n x 2 in the plane, n x 3 in space.
    points: npt.NDArray[Any]
    #: m x 3.
    faces: npt.NDArray[Any]
    #: A number for each face or for each point, or None.
    values: npt.NDArray[Any] | None = None
    #: What the numbers are; empty for those that only tell parts apart.
    label: str = ""


# Stops of a colour map that grows in lightness, from blue over green to yellow, and the colour of surfaces without values.
_STOPS = np.array([[0.27, 0.0, 0.33], [0.23, 0.32, 0.55], [0.13, 0.57, 0.55], [0.37, 0.79, 0.38], [0.99, 0.91, 0.14]])
_PLAIN = np.array([0.55, 0.68, 0.82])
# Pixels are drawn so many times as fine in both directions and averaged.
_FINE = 2
# Edges are drawn where faces are at most so many: of smaller ones nothing but edges would be seen.
_WITH_EDGES = 4000


def _projected(points: Array) -> Array:
    """Points of space as seen from aside of the direction in which they spread least; x to the right, y upwards, z to the eye."""
    if points.shape[1] == 2:
        return np.column_stack([points, np.zeros(len(points))])
    centred = points - points.mean(0)
    axes = np.linalg.eigh(centred.T @ centred)[1].T[::-1]
    axes *= np.sign(axes[np.arange(3), np.abs(axes).argmax(1)])[:, None]
    if np.linalg.det(axes) < 0:
        axes[2] = -axes[2]
    spread = np.abs(centred @ axes[2]).max()
    # What is flat is seen from above.
    tilt, turn = (0.0, 0.0) if spread < 1e-6 * np.abs(centred).max() else (0.45, 0.35)
    c, s, d, e = np.cos(tilt), np.sin(tilt), np.cos(turn), np.sin(turn)
    aside = np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ np.array([[d, 0, e], [0, 1, 0], [-e, 0, d]])
    return np.asarray(centred @ axes.T @ aside.T)


def colors_of(scene: Scene) -> Array:
    """The colour of every face, m x 3."""
    if scene.values is None:
        return np.broadcast_to(_PLAIN, (len(scene.faces), 3))
    values = np.asarray(scene.values, float)
    if len(values) != len(scene.faces):
        values = values[scene.faces].mean(1)
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, [0.01, 0.99]) if finite.size else (0.0, 1.0)
    share = np.nan_to_num(np.clip((values - low) / (high - low or 1.0), 0, 1))
    return np.column_stack([np.interp(share, np.linspace(0, 1, len(_STOPS)), stop) for stop in _STOPS.T])


def _fitted(points: Array, width: int, height: int) -> Array:
    """Points in pixels, y downwards, with a margin."""
    low, high = points[:, :2].min(0), points[:, :2].max(0)
    scale = 0.94 * min(width / max(high[0] - low[0], 1e-300), height / max(high[1] - low[1], 1e-300))
    middle = (low + high) / 2
    x, y, z = points.T
    return np.column_stack([width / 2 + scale * (x - middle[0]), height / 2 - scale * (y - middle[1]), scale * z])


def _shades(corners: Array) -> Array:
    """The light on every face, from the upper left in front; both sides are lit."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(lengths > 0, lengths, 1)
    normals *= np.where(normals[:, 2:] < 0, -1, 1)
    return np.asarray(0.35 + 0.65 * np.clip(normals @ (np.array([-0.4, -0.5, 0.77]) / 0.999), 0, 1))


def _pixels(corners: Array, width: int, height: int) -> tuple[npt.NDArray[np.intp], ...]:
    """All pairs of a face and a pixel in its bounding box: faces, columns, rows."""
    low = np.clip(np.floor(corners[:, :, :2].min(1)).astype(int), 0, [width - 1, height - 1])
    high = np.clip(np.ceil(corners[:, :, :2].max(1)).astype(int), 0, [width - 1, height - 1])
    wide, tall = (high - low + 1).T
    counts = wide * tall
    face = np.repeat(np.arange(len(corners)), counts)
    at = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return face, low[face, 0] + at % wide[face], low[face, 1] + at // wide[face]


def drawn(scene: Scene, width: int = 240, height: int = 180) -> npt.NDArray[np.uint8]:
    """The picture of a scene, height x width x 4: red, green, blue and opacity of each pixel."""
    wide, tall = _FINE * width, _FINE * height
    canvas = np.zeros((tall, wide, 4))
    points = np.asarray(scene.points, float)
    used = np.isfinite(points).all(1)[scene.faces].all(1)
    faces = np.asarray(scene.faces)[used]
    if len(faces) == 0:
        return np.zeros((height, width, 4), np.uint8)
    places = np.zeros((len(points), 3))
    seen = np.unique(faces)
    places[seen] = _fitted(_projected(points[seen]), wide, tall)
    corners = places[faces]
    colors = colors_of(scene)[used]
    if points.shape[1] == 3:
        colors = colors * _shades(corners)[:, None]
    face, column, row = _pixels(corners, wide, tall)
    a, b, c = (corners[face, k] for k in range(3))
    x, y = column + 0.5, row + 0.5
    doubled = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    with np.errstate(all="ignore"):
        u = ((b[:, 0] - x) * (c[:, 1] - y) - (c[:, 0] - x) * (b[:, 1] - y)) / doubled
        v = ((c[:, 0] - x) * (a[:, 1] - y) - (a[:, 0] - x) * (c[:, 1] - y)) / doubled
    w = 1 - u - v
    inside = np.flatnonzero(np.minimum(np.minimum(u, v), w) >= -1e-9)
    depth = (u * a[:, 2] + v * b[:, 2] + w * c[:, 2])[inside]
    # Of the faces at a pixel the nearest is written last.
    inside = inside[np.argsort(depth, kind="stable")]
    tone = colors[face[inside]]
    if len(faces) <= _WITH_EDGES:
        tone = tone * np.where(_at_edge(corners, face, inside, (u, v, w)), 0.6, 1)[:, None]
    canvas[row[inside], column[inside]] = np.column_stack([tone, np.ones(len(tone))])
    blocks = canvas.reshape(height, _FINE, width, _FINE, 4).sum((1, 3))
    cover = blocks[:, :, 3:]
    blocks = np.concatenate([blocks[:, :, :3] / np.where(cover > 0, cover, 1), cover / _FINE**2], axis=2)
    return np.asarray(np.round(255 * np.clip(blocks, 0, 1)), np.uint8)


def _at_edge(corners: Array, face: Any, inside: Any, weights: tuple[Array, ...]) -> npt.NDArray[np.bool_]:
    """True of pixels within half a pixel of an edge of their face."""
    near = np.zeros(len(inside), bool)
    sides = [np.linalg.norm(corners[:, (k + 2) % 3, :2] - corners[:, (k + 1) % 3, :2], axis=1) for k in range(3)]
    (ax, ay), (bx, by) = ((corners[:, k, :2] - corners[:, 0, :2]).T for k in (1, 2))
    areas = np.abs(ax * by - ay * bx)
    for weight, side in zip(weights, sides, strict=True):
        heights = areas / np.where(side > 0, side, 1)
        near |= weight[inside] * heights[face[inside]] < 0.5
    return near


def png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """The bytes of a PNG file of a picture with opacity."""
    height, width = pixels.shape[:2]
    lines = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)

    def part(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + part(b"IHDR", head) + part(b"IDAT", zlib.compress(lines.tobytes(), 6)) + part(b"IEND", b"")


def html(title: str, figures: Mapping[str, str], scene: Scene | None) -> str:
    """A picture with a table of figures beside it, as notebooks show it."""
    rows = "".join(
        f'<tr><td style="text-align:left">{escape(name)}</td><td style="text-align:right">{escape(value)}</td></tr>'
        for name, value in figures.items()
    )
    image = ""
    if scene is not None:
        data = base64.b64encode(png(drawn(scene))).decode()
        told = f"colours: {scene.label}" if scene.label else title
        image = f'<img alt="{escape(told)}" title="{escape(told)}" width="240" height="180" src="data:image/png;base64,{data}">'
    return (
        f'<div style="display:flex;align-items:center;gap:1em">{image}'
        f'<table><caption style="text-align:left"><b>{escape(title)}</b></caption>{rows}</table></div>'
    )
