"""ricci: discrete surface Ricci flow. Metrics of prescribed curvature on triangle meshes, their layouts, and what is built on them.

    import ricci

    flat = ricci.flow(V, F, target="auto:8")          # n x 3 positions, m x 3 faces; eight cones
    uv = ricci.layout(flat).uv()                      # m x 3 x 2, the coordinates of every corner
    disk = ricci.uniformize("bunny.obj")              # sphere, plane or hyperbolic plane

Every function takes arrays `V, F`, or in place of `V` alone a `Mesh`, a file's name, a pair `(V, F)`, or a mesh of trimesh, meshio,
PyVista or nibabel. Long calls release the GIL, show their progress (`progress=callback`) and stop at Ctrl-C. Failures are exceptions
with the element and the amount (`RicciError`). Results are identical bit for bit for any number of threads.
"""

from ricci._library import VERSION as __version__
from ricci.adapters import as_mesh, to_gifti, to_meshio, to_pyvista, to_trimesh
from ricci.atlases import Place, Structure, structure, structures
from ricci.bicubics import Bicubic, bicubic
from ricci.circle import CircleDomain, circles
from ricci.cohorts import CohortResult, Job, cohort
from ricci.control import Control
from ricci.covering import Cover, Deck, Dirichlet, cover, deck, dirichlet
from ricci.errors import (
    ArgumentError,
    ArgumentTypeError,
    Cancelled,
    FileError,
    InternalError,
    LayoutError,
    LeftOutError,
    MatchingError,
    MeshError,
    MetricError,
    NotConverged,
    OutOfMemory,
    ParseError,
    RicciError,
    SolverError,
    SplineError,
    TargetError,
)
from ricci.form import Forms, HarmonicMap, forms, harmonic, harmonic_map
from ricci.fundamental import Domain, Homotopy, homotopy
from ricci.layouts import Charts, Layout, RepairedInput, SheetLine, charts, layout
from ricci.log import log_to_logging
from ricci.maps import Map
from ricci.matching import Matching, match
from ricci.mesh import Mesh, read
from ricci.metrics import Metric, Report, Solver, flow, metric
from ricci.quad_meshes import QuadLayout, Quads, quad_layout, quads
from ricci.quad_splines import QuadSpline, quad_spline
from ricci.seams import Seamless, cross_field, seamless
from ricci.shapes import change, hyperelliptic_periods, make
from ricci.soup import Defect, Hole, Loop, Soup
from ricci.splines import Spline, flat_metric, spline, spline_domain
from ricci.status import Status
from ricci.uniform import Uniform, uniformize

__all__ = [
    "ArgumentError",
    "ArgumentTypeError",
    "Bicubic",
    "Cancelled",
    "Charts",
    "CircleDomain",
    "CohortResult",
    "Control",
    "Cover",
    "Deck",
    "Defect",
    "Dirichlet",
    "Domain",
    "FileError",
    "Forms",
    "HarmonicMap",
    "Hole",
    "Homotopy",
    "InternalError",
    "Job",
    "Layout",
    "LayoutError",
    "LeftOutError",
    "Loop",
    "Map",
    "Matching",
    "MatchingError",
    "Mesh",
    "MeshError",
    "Metric",
    "MetricError",
    "NotConverged",
    "OutOfMemory",
    "ParseError",
    "Place",
    "QuadLayout",
    "QuadSpline",
    "Quads",
    "RepairedInput",
    "Report",
    "RicciError",
    "Seamless",
    "SheetLine",
    "Solver",
    "SolverError",
    "Soup",
    "Spline",
    "SplineError",
    "Status",
    "Structure",
    "TargetError",
    "Uniform",
    "__version__",
    "as_mesh",
    "bicubic",
    "change",
    "charts",
    "circles",
    "cohort",
    "cover",
    "cross_field",
    "deck",
    "dirichlet",
    "flat_metric",
    "flow",
    "forms",
    "harmonic",
    "harmonic_map",
    "homotopy",
    "hyperelliptic_periods",
    "layout",
    "log_to_logging",
    "make",
    "match",
    "metric",
    "quad_layout",
    "quad_spline",
    "quads",
    "read",
    "seamless",
    "spline",
    "spline_domain",
    "structure",
    "structures",
    "to_gifti",
    "to_meshio",
    "to_pyvista",
    "to_trimesh",
    "uniformize",
]
