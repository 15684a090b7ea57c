//! The curves and surfaces of a STEP file, and the lines in the parameters of surfaces that its edges follow.

use crate::geometry::vector::{Vector, perpendicular};
use crate::spline::cylinder::Cylinder;
use step_io::model as m;
use step_io::{Ap242Author, AuthorError};

/// What is added to a file, or why it cannot be.
pub(super) type Authored<T> = Result<T, AuthorError>;

/// A B-spline curve without weights.
pub(crate) struct StepCurveGeometry {
    pub degree: usize,
    /// Every knot as often as it counts.
    pub knots: Vec<f64>,
    pub control_points: Vec<Vector>,
}

/// A tensor-product B-spline surface without weights.
pub(crate) struct StepSurfaceGeometry {
    /// The degree in both directions.
    pub degree: usize,
    /// Every knot as often as it counts, in each direction.
    pub knots: [Vec<f64>; 2],
    /// Control point `[i][j]`: i along the first parameter, j along the second.
    pub control_points: Vec<Vec<Vector>>,
}

/// The first and last of some knots.
fn domain(knots: &[f64]) -> [f64; 2] {
    [knots[0], knots[knots.len() - 1]]
}

impl StepCurveGeometry {
    /// Where the parameter begins and ends.
    pub(super) fn domain(&self) -> [f64; 2] {
        domain(&self.knots)
    }
}

impl StepSurfaceGeometry {
    /// The parameters at which a side begins and ends. Sides go counterclockwise from that on which the second parameter is least;
    /// `reversed`: against that way.
    pub(super) fn side(&self, side: usize, reversed: bool) -> [[f64; 2]; 2] {
        let [u, v] = [domain(&self.knots[0]), domain(&self.knots[1])];
        let corner = |k: usize| [[u[0], v[0]], [u[1], v[0]], [u[1], v[1]], [u[0], v[1]]][k % 4];
        if reversed { [corner(side + 1), corner(side)] } else { [corner(side), corner(side + 1)] }
    }
}

/// Adds a point in space.
pub(super) fn add_point(author: &mut Ap242Author, at: Vector) -> Authored<m::CartesianPointId> {
    author.add_cartesian_point("", at.into())
}

fn add_points(author: &mut Ap242Author, points: &[Vector]) -> Authored<Vec<m::CartesianPointRef>> {
    points.iter().map(|&at| add_point(author, at).map(m::CartesianPointRef::CartesianPoint)).collect()
}

/// Each knot once, and how often it counts.
fn with_multiplicities(knots: &[f64]) -> (Vec<f64>, Vec<i64>) {
    knots.chunk_by(|a, b| a == b).map(|same| (same[0], same.len() as i64)).unzip()
}

/// Adds a curve in space.
pub(super) fn add_curve(author: &mut Ap242Author, curve: &StepCurveGeometry) -> Authored<m::CurveRef> {
    let points = add_points(author, &curve.control_points)?;
    let (knots, multiplicities) = with_multiplicities(&curve.knots);
    let curve = author.add_b_spline_curve_with_knots(
        "",
        curve.degree as i64,
        points,
        m::BSplineCurveForm::Unspecified,
        m::Logical::Unknown,
        m::Logical::Unknown,
        multiplicities,
        knots,
        m::KnotType::Unspecified,
    )?;
    Ok(m::CurveRef::BSplineCurveWithKnots(curve))
}

/// Adds a surface.
pub(super) fn add_surface(
    author: &mut Ap242Author,
    surface: &StepSurfaceGeometry,
) -> Authored<m::BSplineSurfaceWithKnotsId> {
    let points = surface.control_points.iter().map(|row| add_points(author, row));
    let points = points.collect::<Authored<Vec<_>>>()?;
    let [(u_knots, u_multiplicities), (v_knots, v_multiplicities)] =
        [with_multiplicities(&surface.knots[0]), with_multiplicities(&surface.knots[1])];
    author.add_b_spline_surface_with_knots(
        "",
        surface.degree as i64,
        surface.degree as i64,
        points,
        m::BSplineSurfaceForm::Unspecified,
        m::Logical::Unknown,
        m::Logical::Unknown,
        m::Logical::Unknown,
        u_multiplicities,
        v_multiplicities,
        u_knots,
        v_knots,
        m::KnotType::Unspecified,
    )
}

/// The surface of a face.
#[derive(Clone, Copy)]
pub(super) enum FaceSurface {
    Spline(m::BSplineSurfaceWithKnotsId),
    Plane(m::PlaneId),
    /// With true where the patch has the normals that point to the axis.
    Cylinder(m::CylindricalSurfaceId, bool),
}

/// A plane with its unit normal.
#[derive(Clone, Copy)]
pub(super) struct StepPlane {
    pub origin: Vector,
    pub normal: Vector,
}

/// Adds a plane.
pub(super) fn add_plane(author: &mut Ap242Author, plane: StepPlane) -> Authored<m::PlaneId> {
    let placement = add_placement(author, plane.origin, plane.normal, perpendicular(plane.normal))?;
    author.add_plane("", placement)
}

/// Adds a cylinder. `away`: the unit direction from the axis in which its parameters begin, and a reader has a seam.
pub(super) fn add_cylinder(
    author: &mut Ap242Author,
    cylinder: &Cylinder,
    away: Vector,
) -> Authored<m::CylindricalSurfaceId> {
    let placement = add_placement(author, cylinder.origin, cylinder.axis, away)?;
    author.add_cylindrical_surface("", placement, cylinder.radius)
}

/// Adds a place with a unit direction through it, and another one across.
fn add_placement(
    author: &mut Ap242Author,
    origin: Vector,
    direction: Vector,
    across: Vector,
) -> Authored<m::Axis2Placement3dRef> {
    let origin = m::CartesianPointRef::CartesianPoint(add_point(author, origin)?);
    let direction = m::DirectionRef::Direction(author.add_direction("", direction.into())?);
    let across = m::DirectionRef::Direction(author.add_direction("", across.into())?);
    let placement = author.add_axis2_placement3d("", origin, Some(direction), Some(across))?;
    Ok(m::Axis2Placement3dRef::Axis2Placement3d(placement))
}

/// The plane of the parameters of surfaces.
pub(super) struct ParameterPlane(m::ComplexEntityId);

impl ParameterPlane {
    /// Adds the plane to a file.
    pub(super) fn add(author: &mut Ap242Author) -> Authored<Self> {
        let (identifier, kind) = (author.text(""), author.text("2D"));
        let plane = author.add_complex(vec![
            m::PartialEntity::GeometricRepresentationContext { coordinate_space_dimension: 2 },
            m::PartialEntity::ParametricRepresentationContext,
            m::PartialEntity::RepresentationContext { context_identifier: identifier, context_type: kind },
        ])?;
        Ok(Self(plane))
    }

    /// Adds the line in the parameters of a surface from one place to another, which it reaches as its own parameter goes through
    /// `domain`.
    pub(super) fn add_line(
        &self,
        author: &mut Ap242Author,
        surface: m::BSplineSurfaceWithKnotsId,
        domain: [f64; 2],
        [from, to]: [[f64; 2]; 2],
    ) -> Authored<m::PcurveId> {
        let way = [0, 1].map(|k| to[k] - from[k]);
        let length = way[0].hypot(way[1]);
        let speed = length / (domain[1] - domain[0]);
        let towards = way.map(|x| x / length);
        let origin: [f64; 2] = [0, 1].map(|k| from[k] - domain[0] * speed * towards[k]);
        let origin = author.add_cartesian_point("", origin.into())?;
        let towards = author.add_direction("", towards.into())?;
        let speed = author.add_vector("", m::DirectionRef::Direction(towards), speed)?;
        let origin = m::CartesianPointRef::CartesianPoint(origin);
        let line =
            m::RepresentationItemRef::Line(author.add_line("", origin, m::VectorRef::Vector(speed))?);
        let plane = m::RepresentationContextRef::Complex(self.0);
        let in_plane = author.add_definitional_representation("", vec![line], plane)?;
        let in_plane = m::DefinitionalRepresentationRef::DefinitionalRepresentation(in_plane);
        author.add_pcurve("", m::SurfaceRef::BSplineSurfaceWithKnots(surface), in_plane)
    }
}
