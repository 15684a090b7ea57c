//! Open shells of a STEP file, which the builder of files does not know.

use super::geometry::Authored;
use step_io::build::{Part, UnitsInput};
use step_io::model as m;
use step_io::{Ap242Author, StepBuilder};

/// Adds open shells as one surface model of the part. The builder knows solids only, and its own representation of such a part holds no
/// more than the origin; so this is a second representation with the same units.
pub(super) fn add_shells(
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
