#!/usr/bin/env python3
"""What OpenCASCADE does to a solid in a STEP file: two offsets, a box that is cut off with a fillet along the cut, a bore. One line of JSON.

usage: python docs/results/cad_operations.py PART.step     (in a Python with: pip install cadquery-ocp)
"""

import json
import math
import sys
import time

from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepGProp import BRepGProp
from OCP.BRepOffset import BRepOffset_Skin
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeOffsetShape
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.GeomAbs import GeomAbs_Arc
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

# Over the diagonal of the bounding box: the offset, the radius of the fillet and of the bore, and the tolerance of offsets and of points on a plane.
OFFSET = 0.01
FILLET = 0.005
BORE = 0.03
NEAR = 1e-5
# Where box and bore are: over the diagonal off the middle, so that they go through nothing special.
AWAY = [0.011, 0.007, 0.0137]


def volume(shape):
    """The volume that a shape encloses."""
    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, found)
    return found.Mass()


def is_valid(shape):
    """True if OpenCASCADE's own check finds no fault."""
    return BRepCheck_Analyzer(shape).IsValid()


def bounds(shape):
    """The least and the greatest coordinates."""
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    return [[corner.X(), corner.Y(), corner.Z()] for corner in (box.CornerMin(), box.CornerMax())]


def offset(shape, by, tolerance):
    """The shape with its faces moved outwards."""
    made = BRepOffsetAPI_MakeOffsetShape()
    made.PerformByJoin(shape, by, tolerance, BRepOffset_Skin, False, False, GeomAbs_Arc, False)
    return made.Shape()


def without(shape, tool):
    """The shape without what it has in common with another."""
    made = BRepAlgoAPI_Cut(shape, tool)
    made.Build()
    return made.Shape()


def edges_at_height(shape, height, tolerance):
    """The edges in a horizontal plane, each once."""
    found = []
    each = TopExp_Explorer(shape, TopAbs_EDGE)
    while each.More():
        edge = TopoDS.Edge(each.Current())
        each.Next()
        if any(edge.IsSame(known) for known in found):
            continue
        curve = BRepAdaptor_Curve(edge)
        first, last = curve.FirstParameter(), curve.LastParameter()
        heights = [curve.Value(first + share * (last - first)).Z() for share in (0, 0.3, 0.6, 1)]
        if all(abs(z - height) < tolerance for z in heights):
            found.append(edge)
    return found


def filleted(shape, edges, radius):
    """The shape with round edges."""
    made = BRepFilletAPI_MakeFillet(shape)
    for edge in edges:
        made.Add(radius, edge)
    made.Build()
    return made.Shape()


def tried(made, size):
    """What came of an operation: its volume over that of the whole, and if it is valid; or why there is nothing. With the shape."""
    start = time.perf_counter()
    try:
        shape = made()
        result = {"valid": is_valid(shape), "volume": volume(shape) / size}
    except Exception as error:
        shape, result = None, {"valid": False, "why": str(error).strip().splitlines()[0][:80]}
    return {**result, "seconds": time.perf_counter() - start}, shape


def operations(shape):
    """All operations on a solid."""
    lowest, highest = bounds(shape)
    diagonal, size = math.dist(lowest, highest), volume(shape)
    middle = [0.5 * (a + b) + away * diagonal for a, b, away in zip(lowest, highest, AWAY)]
    found = {"valid": is_valid(shape), "volume": size}
    found["offset"], larger = tried(lambda: offset(shape, OFFSET * diagonal, NEAR * diagonal), size)
    found["offset again"], _ = tried(lambda: offset(larger, OFFSET * diagonal, NEAR * diagonal), size)
    below, above = [x - diagonal for x in lowest[:2]] + [middle[2]], [x + diagonal for x in highest]
    box = BRepPrimAPI_MakeBox(gp_Pnt(*below), gp_Pnt(*above)).Shape()
    found["cut"], lower = tried(lambda: without(shape, box), size)

    def rounded():
        edges = edges_at_height(lower, middle[2], NEAR * diagonal)
        return filleted(lower, edges, FILLET * diagonal)

    found["fillet"], _ = tried(rounded, size)
    axis = gp_Ax2(gp_Pnt(middle[0], middle[1], lowest[2] - diagonal), gp_Dir(0, 0, 1))
    drill = BRepPrimAPI_MakeCylinder(axis, BORE * diagonal, 4 * diagonal).Shape()
    found["bore"], _ = tried(lambda: without(shape, drill), size)
    return found


def main():
    reader = STEPControl_Reader()
    if reader.ReadFile(sys.argv[1]) != IFSelect_ReturnStatus.IFSelect_RetDone:
        sys.exit(f"{sys.argv[1]}: not read")
    reader.TransferRoots()
    print(json.dumps(operations(reader.OneShape())))


if __name__ == "__main__":
    main()
