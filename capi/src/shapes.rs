//! Sample surfaces, and what can be done to a surface in space.

use crate::arrays;
use crate::choice::choices;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use num_complex::Complex64;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, Intrinsic, Sliver, TorusKnot};
use std::sync::Arc;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Sphere,
    Ellipsoid,
    Disk,
    Annulus,
    Torus,
    Genus,
    Knot,
    FlatTorus,
    Bolza,
    OneVertex,
    TwoVertex,
    TwoTriangles,
    Pants,
    Hyperelliptic,
}

choices!(SHAPES: Shape = "shape", [
    RICCI_SHAPE_SPHERE => Shape::Sphere,
    RICCI_SHAPE_ELLIPSOID => Shape::Ellipsoid,
    RICCI_SHAPE_DISK => Shape::Disk,
    RICCI_SHAPE_ANNULUS => Shape::Annulus,
    RICCI_SHAPE_TORUS => Shape::Torus,
    RICCI_SHAPE_GENUS => Shape::Genus,
    RICCI_SHAPE_KNOT => Shape::Knot,
    RICCI_SHAPE_FLAT_TORUS => Shape::FlatTorus,
    RICCI_SHAPE_BOLZA => Shape::Bolza,
    RICCI_SHAPE_ONE_VERTEX => Shape::OneVertex,
    RICCI_SHAPE_TWO_VERTEX => Shape::TwoVertex,
    RICCI_SHAPE_TWO_TRIANGLES => Shape::TwoTriangles,
    RICCI_SHAPE_PANTS => Shape::Pants,
    RICCI_SHAPE_HYPERELLIPTIC => Shape::Hyperelliptic,
]);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Change {
    Punch,
    Grade,
    Caps,
    Needles,
    Noise,
    Invert,
}

choices!(CHANGES: Change = "change", [
    RICCI_CHANGE_PUNCH => Change::Punch,
    RICCI_CHANGE_GRADE => Change::Grade,
    RICCI_CHANGE_CAPS => Change::Caps,
    RICCI_CHANGE_NEEDLES => Change::Needles,
    RICCI_CHANGE_NOISE => Change::Noise,
    RICCI_CHANGE_INVERT => Change::Invert,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_shape {
    pub size: usize,
    pub shape: u32,
    pub reserved: u32,
    pub genus: usize,
    pub n: usize,
    pub m: usize,
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub p: u32,
    pub q: u32,
    pub points: *const f64,
    pub n_points: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_shape, "shape");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_change_spec {
    pub size: usize,
    pub change: u32,
    pub vertex: u32,
    pub count: usize,
    pub amount: f64,
    pub seed: u64,
    pub centre: [f64; 3],
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_change_spec, "change");

fn branch_points(points: *const f64, n_points: usize) -> Outcome<Vec<Complex64>> {
    let points: Vec<[f64; 2]> = arrays::array("points", points.cast(), n_points)?;
    Ok(points.into_iter().map(|[re, im]| Complex64::new(re, im)).collect())
}

/// Bytes that an entry of a period matrix takes while it is found.
const PERIOD: usize = 1 << 8;

fn intrinsic(surface: Intrinsic) -> Outcome<ricci_mesh> {
    let (connectivity, lengths) = surface.build()?;
    Ok(ricci_mesh::intrinsic(Arc::new(connectivity), Arc::new(lengths), surface.geometry))
}

/// About how many faces a surface will have, as the header counts them.
fn faces_of(shape: Shape, [n, m, genus]: [usize; 3]) -> usize {
    let square = n.saturating_mul(n);
    let cut = |times: usize| 4_usize.saturating_pow(times.min(32) as u32);
    match shape {
        Shape::Sphere | Shape::Ellipsoid => square.saturating_mul(20),
        Shape::Disk => square.saturating_mul(6),
        Shape::Annulus | Shape::Torus | Shape::Knot | Shape::FlatTorus => {
            n.saturating_mul(m).saturating_mul(2)
        }
        Shape::Genus => genus.saturating_mul(6).saturating_mul(square).saturating_mul(16),
        Shape::Bolza | Shape::Pants => cut(n).saturating_mul(16),
        Shape::OneVertex | Shape::TwoVertex => genus.saturating_mul(4),
        Shape::TwoTriangles => 2,
        Shape::Hyperelliptic => square.saturating_mul(40),
    }
}

/// Memory for a surface that the library does not refuse for its size.
fn room_for(shape: Shape, sizes: [usize; 3]) -> Outcome<memory::Reserve> {
    let faces = faces_of(shape, sizes);
    memory::work(if faces > u32::MAX as usize { 0 } else { faces }, memory::MESH)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_make(shape: *const ricci_shape, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make(mesh, || {
        if shape.is_null() {
            return Err(Failure::null("shape"));
        }
        let ricci_shape { shape, genus, n, m, a, b, c, p, q, points, n_points, .. } = structs::read(shape)?;
        let shape = SHAPES.choose(shape)?;
        let _reserve = room_for(shape, [n, m, genus])?;
        ricci_mesh::from_soup(match shape {
            Shape::Sphere => shapes::icosphere(n)?,
            Shape::Ellipsoid => shapes::ellipsoid([a, b, c], n)?,
            Shape::Disk => shapes::disk(n)?,
            Shape::Annulus => shapes::annulus(a, b, n, m)?,
            Shape::Torus => shapes::torus(a, b, n, m)?,
            Shape::Genus => shapes::tapered_genus(genus, n, if a == 0.0 { 1.0 } else { a })?,
            Shape::Knot => TorusKnot { p, q, big: a, small: b }.torus(c, n, m)?,
            Shape::FlatTorus => return intrinsic(shapes::flat_torus([a, b], n, m)?),
            Shape::Bolza => return intrinsic(shapes::bolza(n)?),
            Shape::OneVertex => return intrinsic(shapes::one_vertex(genus)?),
            Shape::TwoVertex => return intrinsic(shapes::two_vertex(genus)?),
            Shape::TwoTriangles => return intrinsic(shapes::two_triangle_sphere()),
            Shape::Pants => return intrinsic(shapes::pants([a, b, c], n)?),
            Shape::Hyperelliptic => {
                return intrinsic(shapes::hyperelliptic(&branch_points(points, n_points)?, n)?);
            }
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_change(
    mesh: *const ricci_mesh,
    change: *const ricci_change_spec,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(result, || {
        if change.is_null() {
            return Err(Failure::null("change"));
        }
        let ricci_change_spec { change, vertex, count, amount, seed, centre, .. } = structs::read(change)?;
        let mesh = shared(mesh)?;
        let _reserve = memory::work(mesh.connectivity.n_faces(), memory::MESH)?;
        let Soup { positions, faces, .. } = mesh.soup()?;
        let mut soup = Soup::new(positions, faces);
        match CHANGES.choose(change)? {
            Change::Punch => soup = shapes::punch(&soup, count)?,
            Change::Grade => shapes::grade(&mut soup, vertex, count)?,
            Change::Caps => shapes::slivers(&mut soup, Sliver::Cap, count, amount, seed)?,
            Change::Needles => shapes::slivers(&mut soup, Sliver::Needle, count, amount, seed)?,
            Change::Noise => shapes::noise(&mut soup, amount, seed)?,
            Change::Invert => shapes::invert(&mut soup, centre, amount)?,
        }
        ricci_mesh::from_soup(soup)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_hyperelliptic_periods(
    points: *const f64,
    n_points: usize,
    periods: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|| {
        let points = branch_points(points, n_points)?;
        let _reserve = memory::work(n_points.saturating_mul(n_points), PERIOD)?;
        let tau = period_matrix(&points)?;
        let entries: Vec<f64> = tau.iter().flatten().flat_map(|z| [z.re, z.im]).collect();
        arrays::copy_out("periods", &entries, periods, capacity)
    })
}
