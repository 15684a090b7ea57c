//! STEP files (AP242) of tensor-product patches: closed parts as solids, open ones as shells, with common edges and vertices.

use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use std::io::Write;
use step_io::build::{CurveInput, FaceBoundInput, Part, SurfaceInput, UnitsInput};
use step_io::model as m;
use step_io::scene::{NurbsCurve, NurbsSurface};
use step_io::{Ap242Author, AuthorError, Orientation, StepBuilder, StepModel};

/// The time stamp of every file: fixed, so that the same patches give the same bytes.
const TIME_STAMP: &str = "2000-01-01T00:00:00Z";
/// Distance, over the diagonal, below which a reader may take two points as one. Common curves and points agree to the last bit.
const UNCERTAINTY: f64 = 1e-7;

type Authored<T> = std::result::Result<T, AuthorError>;

/// The unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LengthUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Metres.
    Metre,
}

/// Options of STEP files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepOptions {
    /// The name of the part.
    pub name: String,
    /// The unit of the coordinates.
    pub unit: LengthUnit,
}

/// A curve that is a side of one patch or of two.
pub(super) struct StepCurve {
    /// The points at which it begins and ends.
    pub ends: [u32; 2],
    pub curve: NurbsCurve,
}

/// A patch.
pub(super) struct StepPatch {
    pub surface: NurbsSurface,
    /// Its sides along the way around: the curve of each, and true if that runs against the way.
    pub sides: [(usize, bool); 4],
}

/// A connected part of a surface of patches.
pub(super) struct StepPart {
    /// The numbers of its patches.
    pub patches: Vec<usize>,
    /// True if every side of its patches belongs to two of them.
    pub is_closed: bool,
    /// True if the normals of its patches point inwards.
    pub is_inverted: bool,
}

/// Patches that share curves and points.
pub(super) struct StepPatches<'a> {
    /// The points at which curves end.
    pub points: &'a [Vector],
    pub curves: Vec<StepCurve>,
    pub patches: Vec<StepPatch>,
    pub parts: Vec<StepPart>,
    /// The diagonal of the box around the surface.
    pub diagonal: f64,
}

impl StepPatches<'_> {
    /// Writes the patches as STEP AP242. Each part that closes up becomes a solid with outward normals; the others become shells of one
    /// surface model. The same patches give the same bytes.
    ///
    /// # Errors
    /// [`Error::Spline`] for patches that cannot be written; [`Error::Io`], without a path, if writing to `out` fails.
    pub fn write(&self, options: &StepOptions, out: &mut impl Write) -> Result<()> {
        let model = self.model(options).map_err(|why| {
            let message = format!("they cannot be written as STEP: {why}");
            Error::Spline { what: "patches", index: 0, message }
        })?;
        step_io::write(&model, out).map_err(|why| Error::Io { path: "STEP".into(), message: why.to_string() })
    }

    fn model(&self, options: &StepOptions) -> Authored<StepModel> {
        let length = match options.unit {
            LengthUnit::Millimetre => step_io::build::LengthUnit::Millimetre,
            LengthUnit::Metre => step_io::build::LengthUnit::Metre,
        };
        let units = UnitsInput { length, uncertainty: UNCERTAINTY * self.diagonal };
        let mut builder = StepBuilder::new_with(&units)?;
        let header = builder.header_mut();
        header.time_stamp = TIME_STAMP.into();
        header.file_name.clone_from(&options.name);
        header.originating_system = concat!("ricci ", env!("CARGO_PKG_VERSION")).into();
        let part = builder.part(&options.name);
        let vertices = self.points.iter().map(|&p| builder.vertex(p)).collect::<Authored<Vec<_>>>()?;
        let mut edges = Vec::with_capacity(self.curves.len());
        for StepCurve { ends, curve } in &self.curves {
            let [from, to] = ends.map(|p| vertices[p as usize]);
            edges.push(builder.edge(from, to, CurveInput::Nurbs(curve.clone()))?);
        }
        let mut open = Vec::new();
        for part_of in &self.parts {
            let sense = if part_of.is_inverted { Orientation::Reversed } else { Orientation::Forward };
            let of_part = part_of.patches.iter().map(|&at| &self.patches[at]);
            let faces = of_part
                .map(|patch| face(&mut builder, patch, &edges, sense))
                .collect::<Authored<Vec<_>>>()?;
            if part_of.is_closed {
                builder.solid(part, &options.name, faces)?;
            } else {
                open.push(faces);
            }
        }
        if !open.is_empty() {
            add_shells(&mut builder, part, open, &options.name, &units)?;
        }
        Ok(builder.finish())
    }
}

/// Adds a face over a patch. With a reversed sense the loop runs backwards.
fn face(
    builder: &mut StepBuilder,
    patch: &StepPatch,
    edges: &[m::EdgeCurveId],
    sense: Orientation,
) -> Authored<m::AdvancedFaceId> {
    let side = |reversed: bool| if reversed { Orientation::Reversed } else { Orientation::Forward };
    let edges = patch.sides.iter().map(|&(curve, reversed)| (edges[curve], side(reversed))).collect();
    // The loop runs counterclockwise around the surface's own normal; the face's flags turn both at once.
    let bound = FaceBoundInput { edges, outer: true, orientation: sense };
    builder.face(SurfaceInput::Nurbs(patch.surface.clone()), sense, vec![bound])
}

/// Adds open shells as one surface model of the part. The builder knows solids only, and its own representation of such a part holds no
/// more than the origin; so this is a second representation with the same units.
fn add_shells(
    builder: &mut StepBuilder,
    part: Part,
    shells: Vec<Vec<m::AdvancedFaceId>>,
    name: &str,
    units: &UnitsInput,
) -> Authored<()> {
    let shape = builder.part_ids(part).shape;
    let author = builder.author();
    let mut boundary = Vec::with_capacity(shells.len());
    for faces in shells {
        let faces = faces.into_iter().map(m::FaceRef::AdvancedFace).collect();
        boundary.push(m::ShellRef::OpenShell(author.add_open_shell("", faces)?));
    }
    let model = author.add_shell_based_surface_model(name, boundary)?;
    let context = context(author, units)?;
    let representation = author.add_manifold_surface_shape_representation(
        name,
        vec![m::RepresentationItemRef::ShellBasedSurfaceModel(model)],
        m::RepresentationContextRef::Complex(context),
    )?;
    author.add_shape_definition_representation(
        m::RepresentedDefinitionRef::ProductDefinitionShape(shape),
        m::RepresentationRef::ManifoldSurfaceShapeRepresentation(representation),
    )?;
    Ok(())
}

/// Adds a geometric context in three dimensions with these units and radians.
fn context(author: &mut Ap242Author, units: &UnitsInput) -> Authored<m::ComplexEntityId> {
    let prefix = (units.length == step_io::build::LengthUnit::Millimetre).then_some(m::SiPrefix::Milli);
    let named = || m::PartialEntity::NamedUnit { dimensions: None };
    let si = |prefix, name| m::PartialEntity::SiUnit { prefix, name };
    let kinds = [
        vec![m::PartialEntity::LengthUnit, named(), si(prefix, m::SiUnitName::Metre)],
        vec![named(), m::PartialEntity::PlaneAngleUnit, si(None, m::SiUnitName::Radian)],
        vec![named(), si(None, m::SiUnitName::Steradian), m::PartialEntity::SolidAngleUnit],
    ];
    let mut known = Vec::with_capacity(kinds.len());
    for kind in kinds {
        known.push(author.add_complex(kind)?);
    }
    let length = m::MeasureValue {
        type_name: Some(author.text("LENGTH_MEASURE")),
        value: m::MeasureScalar::Real(units.uncertainty),
    };
    let unit = m::UnitRef::Complex(known[0]);
    let uncertainty =
        author.add_uncertainty_measure_with_unit(length, unit, "distance_accuracy_value", None)?;
    let (identifier, kind) = (author.text(""), author.text("3D"));
    author.add_complex(vec![
        m::PartialEntity::GeometricRepresentationContext { coordinate_space_dimension: 3 },
        m::PartialEntity::GlobalUncertaintyAssignedContext {
            uncertainty: vec![m::UncertaintyMeasureWithUnitRef::UncertaintyMeasureWithUnit(uncertainty)],
        },
        m::PartialEntity::GlobalUnitAssignedContext {
            units: known.into_iter().map(m::UnitRef::Complex).collect(),
        },
        m::PartialEntity::RepresentationContext { context_identifier: identifier, context_type: kind },
    ])
}

/// A curve without weights.
pub(super) fn nurbs_curve(degree: usize, knots: Vec<f64>, control_points: Vec<Vector>) -> NurbsCurve {
    NurbsCurve { degree, weights: vec![1.0; control_points.len()], control_points, knots }
}

/// A surface without weights; `control_points[i][j]`: i along the first parameter, j along the second.
pub(super) fn nurbs_surface(
    degree: usize,
    knots: [Vec<f64>; 2],
    control_points: Vec<Vec<Vector>>,
) -> NurbsSurface {
    let [knots_u, knots_v] = knots;
    let weights = control_points.iter().map(|row| vec![1.0; row.len()]).collect();
    NurbsSurface { degree_u: degree, degree_v: degree, control_points, weights, knots_u, knots_v }
}
