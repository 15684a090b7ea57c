"""ricci: discrete surface Ricci flow. Metrics of prescribed curvature on triangle meshes, their layouts, and what is built on them.

    import ricci

    flat = ricci.flow(V, F, target="auto:8")          # n x 3 positions, m x 3 faces; eight cones
    uv = ricci.layout(flat).uv()                      # m x 3 x 2, the coordinates of every corner
    disk = ricci.uniformize("bunny.obj")              # sphere, plane or hyperbolic plane

Every function takes arrays `V, F`, or in place of `V` alone a `Mesh`, a file's name, a pair `(V, F)`, or a mesh of trimesh, meshio,
PyVista or nibabel. Long calls release the GIL, show their progress (`progress=callback`) and stop at Ctrl-C. Failures are exceptions
with the element and the amount (`RicciError`). Results are identical bit for bit for any number of threads.
"""

from ricci._kept import load
from ricci._library import VERSION as __version__
from ricci.adapters import as_mesh, to_meshio, to_polyscope, to_pyvista, to_trimesh
from ricci.atlases import Place, Structure, StructureOptions, structure, structures
from ricci.bicubics import Bicubic, BicubicOptions, StepOptions, bicubic
from ricci.circle import CircleDomain, CircleOptions, circles
from ricci.cohorts import CohortOptions, CohortResult, Job, ModuliDistances, classical_scaling, cohort, moduli_distances
from ricci.control import Control
from ricci.control_meshes import fit_control_mesh
from ricci.cortices import Brain, brain, flat_part, inflate, medial_wall
from ricci.covering import Cover, CoverOptions, Deck, DeckSpec, Dirichlet, cover, deck, dirichlet
from ricci.errors import (
    ArgumentError,
    ArgumentTypeError,
    Cancelled,
    ConvergenceWarning,
    FileError,
    InternalError,
    LayoutError,
    LeftOutError,
    MatchingError,
    MeshError,
    MetricError,
    OutOfMemory,
    ParseError,
    RicciError,
    SolverError,
    SplineError,
    TargetError,
)
from ricci.flat_maps import (
    Distortion,
    FlatMap,
    FlattenOptions,
    SeamlessFlatMap,
    SeamlessFlatOptions,
    SphereFlatOptions,
    flatten,
    flatten_seamless,
    flatten_sphere,
)
from ricci.form import Forms, FormsOptions, HarmonicMap, HarmonicOptions, forms, harmonic, harmonic_map
from ricci.freesurfers import (
    Annotation,
    Patch,
    VertexLabel,
    read_annotation,
    read_label,
    read_patch,
    read_values,
    write_annotation,
    write_label,
    write_patch,
    write_values,
)
from ricci.fundamental import Domain, Homotopy, homotopy
from ricci.gifti import Gifti, from_gifti, to_gifti
from ricci.gifti_files import (
    GiftiColumn,
    GiftiColumns,
    GiftiLabel,
    GiftiNotes,
    GiftiTransform,
    read_gifti_columns,
    read_gifti_notes,
    write_gifti_labels,
    write_gifti_surface,
    write_gifti_values,
)
from ricci.layouts import Layout, LayoutOptions, RepairedInput, SheetLine, layout
from ricci.log import log_to_logging
from ricci.maps import Map
from ricci.marks import landmarks
from ricci.matching import Matching, MatchOptions, Points, match
from ricci.mesh import Attributes, Mesh, read
from ricci.metrics import FlowJob, FlowOptions, Metric, Report, flow, metric
from ricci.moduli import (
    BoundsOptions,
    ModulusBounds,
    PeriodBounds,
    dilatation_bracket,
    fenchel_nielsen,
    modulus_bounds,
    pants,
    period_bounds,
)
from ricci.packed_charts import Charts, charts
from ricci.pages import Page, show
from ricci.quad_meshes import QuadLayout, Quads, QuadsOptions, quad_layout, quads
from ricci.quad_splines import QuadSpline, QuadSplineOptions, fit_few_patches, quad_spline
from ricci.scenes import SceneFile, SceneOptions
from ricci.seams import Seamless, SeamlessOptions, cross_field, seamless
from ricci.shapes import ChangeOptions, ShapeOptions, change, hyperelliptic_periods, make, make_loops
from ricci.sheets import Darted, DartOptions, Strains, flatten_darts, strains
from ricci.solvers import Solver
from ricci.soup import Defect, Hole, Loop, RepairOptions, Soup
from ricci.spline_domains import flat_metric, spline_domain
from ricci.splines import PlaneOptions, Spline, SurfaceOptions, spline
from ricci.status import Status
from ricci.texture_atlases import SplitModel, TextureAtlas, TextureOptions, texture_atlas
from ricci.uniform import Uniform, UniformOptions, uniformize

__all__ = [
    "Annotation",
    "ArgumentError",
    "ArgumentTypeError",
    "Attributes",
    "Bicubic",
    "BicubicOptions",
    "BoundsOptions",
    "Brain",
    "Cancelled",
    "ChangeOptions",
    "Charts",
    "CircleDomain",
    "CircleOptions",
    "CohortOptions",
    "CohortResult",
    "Control",
    "ConvergenceWarning",
    "Cover",
    "CoverOptions",
    "DartOptions",
    "Darted",
    "Deck",
    "DeckSpec",
    "Defect",
    "Dirichlet",
    "Distortion",
    "Domain",
    "FileError",
    "FlatMap",
    "FlattenOptions",
    "FlowJob",
    "FlowOptions",
    "Forms",
    "FormsOptions",
    "Gifti",
    "GiftiColumn",
    "GiftiColumns",
    "GiftiLabel",
    "GiftiNotes",
    "GiftiTransform",
    "HarmonicMap",
    "HarmonicOptions",
    "Hole",
    "Homotopy",
    "InternalError",
    "Job",
    "Layout",
    "LayoutError",
    "LayoutOptions",
    "LeftOutError",
    "Loop",
    "Map",
    "MatchOptions",
    "Matching",
    "MatchingError",
    "Mesh",
    "MeshError",
    "Metric",
    "MetricError",
    "ModuliDistances",
    "ModulusBounds",
    "OutOfMemory",
    "Page",
    "ParseError",
    "Patch",
    "PeriodBounds",
    "Place",
    "PlaneOptions",
    "Points",
    "QuadLayout",
    "QuadSpline",
    "QuadSplineOptions",
    "Quads",
    "QuadsOptions",
    "RepairOptions",
    "RepairedInput",
    "Report",
    "RicciError",
    "SceneFile",
    "SceneOptions",
    "Seamless",
    "SeamlessFlatMap",
    "SeamlessFlatOptions",
    "SeamlessOptions",
    "ShapeOptions",
    "SheetLine",
    "Solver",
    "SolverError",
    "Soup",
    "SphereFlatOptions",
    "Spline",
    "SplineError",
    "SplitModel",
    "Status",
    "StepOptions",
    "Strains",
    "Structure",
    "StructureOptions",
    "SurfaceOptions",
    "TargetError",
    "TextureAtlas",
    "TextureOptions",
    "Uniform",
    "UniformOptions",
    "VertexLabel",
    "__version__",
    "as_mesh",
    "bicubic",
    "brain",
    "change",
    "charts",
    "circles",
    "classical_scaling",
    "cohort",
    "cover",
    "cross_field",
    "deck",
    "dilatation_bracket",
    "dirichlet",
    "fenchel_nielsen",
    "fit_control_mesh",
    "fit_few_patches",
    "flat_metric",
    "flat_part",
    "flatten",
    "flatten_darts",
    "flatten_seamless",
    "flatten_sphere",
    "flow",
    "forms",
    "from_gifti",
    "harmonic",
    "harmonic_map",
    "homotopy",
    "hyperelliptic_periods",
    "inflate",
    "landmarks",
    "layout",
    "load",
    "log_to_logging",
    "make",
    "make_loops",
    "match",
    "medial_wall",
    "metric",
    "moduli_distances",
    "modulus_bounds",
    "pants",
    "period_bounds",
    "quad_layout",
    "quad_spline",
    "quads",
    "read",
    "read_annotation",
    "read_gifti_columns",
    "read_gifti_notes",
    "read_label",
    "read_patch",
    "read_values",
    "seamless",
    "show",
    "spline",
    "spline_domain",
    "strains",
    "structure",
    "structures",
    "texture_atlas",
    "to_gifti",
    "to_meshio",
    "to_polyscope",
    "to_pyvista",
    "to_trimesh",
    "uniformize",
    "write_annotation",
    "write_gifti_labels",
    "write_gifti_surface",
    "write_gifti_values",
    "write_label",
    "write_patch",
    "write_values",
]
