"""Counts and measured figures of the library's objects, as dataclasses with the fields of the `ricci_..._summary` structs."""

from ricci.figures.covered import DeckSummary, DirichletSummary, DomainSummary, HomotopySummary, UniformSummary
from ricci.figures.derived import (
    BicubicSummary,
    BoundsSummary,
    DilatationBracket,
    FormsSummary,
    HarmonicSummary,
    SplineSummary,
    StructureSummary,
)
from ricci.figures.flattened import DartSummary, FlattenSummary
from ricci.figures.four_sided import QuadLayoutSummary, QuadSplineSummary, QuadsSummary
from ricci.figures.matched import FoundLandmarks, MatchingJudgement, MatchingSummary
from ricci.figures.placed import ChartsSummary, CircleDomainSummary, LayoutSummary, MapSummary, RepairedInputSummary, SeamlessSummary
from ricci.figures.surface import ArchiveSummary, MeshSummary, MetricSummary, QualitySummary, RefineSummary, ReportSummary, SoupSummary
from ricci.figures.textured import SceneReport, SceneSummary, TextureAtlasSummary

__all__ = [
    "ArchiveSummary",
    "BicubicSummary",
    "BoundsSummary",
    "ChartsSummary",
    "CircleDomainSummary",
    "DartSummary",
    "DeckSummary",
    "DilatationBracket",
    "DirichletSummary",
    "DomainSummary",
    "FlattenSummary",
    "FormsSummary",
    "FoundLandmarks",
    "HarmonicSummary",
    "HomotopySummary",
    "LayoutSummary",
    "MapSummary",
    "MatchingJudgement",
    "MatchingSummary",
    "MeshSummary",
    "MetricSummary",
    "QuadLayoutSummary",
    "QuadSplineSummary",
    "QuadsSummary",
    "QualitySummary",
    "RefineSummary",
    "RepairedInputSummary",
    "ReportSummary",
    "SceneReport",
    "SceneSummary",
    "SeamlessSummary",
    "SoupSummary",
    "SplineSummary",
    "StructureSummary",
    "TextureAtlasSummary",
    "UniformSummary",
]
