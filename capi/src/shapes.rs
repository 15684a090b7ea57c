//! Sample surfaces, and changes of a surface in space: holes, slivers, noise, inversion.

use crate::arrays::{self, CallerBuffer, copy_rows};
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
use ricci::mesh::shapes::{self, FenchelNielsen, IntrinsicSurface, Sliver, TorusKnot};
use std::sync::Arc;

choices!(enum SampleKind, SHAPES = "shape", [
    RICCI_SHAPE_SPHERE => Sphere,
    RICCI_SHAPE_ELLIPSOID => Ellipsoid,
    RICCI_SHAPE_DISK => Disk,
    RICCI_SHAPE_ANNULUS => Annulus,
    RICCI_SHAPE_TORUS => Torus,
    RICCI_SHAPE_GENUS => Genus,
    RICCI_SHAPE_KNOT => Knot,
    RICCI_SHAPE_FLAT_TORUS => FlatTorus,
    RICCI_SHAPE_BOLZA => Bolza,
    RICCI_SHAPE_ONE_VERTEX => OneVertex,
    RICCI_SHAPE_TWO_VERTEX => TwoVertex,
    RICCI_SHAPE_TWO_TRIANGLES => TwoTriangles,
    RICCI_SHAPE_PANTS => Pants,
    RICCI_SHAPE_HYPERELLIPTIC => Hyperelliptic,
    RICCI_SHAPE_FENCHEL_NIELSEN => FenchelNielsen,
]);

choices!(enum ShapeChange, CHANGES = "change", [
    RICCI_CHANGE_PUNCH => Punch,
    RICCI_CHANGE_GRADE => Grade,
    RICCI_CHANGE_CAPS => Caps,
    RICCI_CHANGE_NEEDLES => Needles,
    RICCI_CHANGE_NOISE => Noise,
    RICCI_CHANGE_INVERT => Invert,
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
sized!(ricci_shape, "shape", reserved);

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

/// The rows of a surface of glued pairs of pants: 3 g − 3 + b curves, then b boundary loops.
fn coordinates(genus: usize, points: *const f64, n_points: usize) -> Outcome<FenchelNielsen> {
    let mut curves: Vec<[f64; 2]> = arrays::array("points", points.cast(), n_points)?;
    let n_boundaries = (n_points + 3).saturating_sub(genus.saturating_mul(3)) / 2;
    let boundaries = curves.split_off(n_points.saturating_sub(n_boundaries));
    if let Some([_, twist]) = boundaries.iter().find(|[_, twist]| *twist != 0.0) {
        return Err(Failure::argument(format!("a boundary loop has the twist {twist}: 0 is needed")));
    }
    let boundaries = boundaries.into_iter().map(|[length, _]| length).collect();
    Ok(FenchelNielsen { genus, curves, boundaries })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_make_loops(
    shape: *const ricci_shape,
    edges: *mut i32,
    edges_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|| {
        if shape.is_null() {
            return Err(Failure::null("shape"));
        }
        let ricci_shape { shape, genus, n, points, n_points, .. } = structs::read(shape)?;
        let shape = SHAPES.choose(shape)?;
        if shape != SampleKind::FenchelNielsen {
            return Err(Failure::argument("only glued pairs of pants are made with loops"));
        }
        let _reserve = room_for(shape, [n, n_points, genus])?;
        let loops = shapes::fenchel_nielsen(&coordinates(genus, points, n_points)?, n)?.loops;
        let rows = loops.iter().map(|path| path.iter().copied());
        copy_rows("edges", rows, CallerBuffer(edges, edges_capacity), CallerBuffer(starts, starts_capacity))
    })
}

/// Most bytes per entry of a period matrix while it is computed.
const PERIOD: usize = 1 << 8;

fn intrinsic(surface: IntrinsicSurface) -> Outcome<ricci_mesh> {
    let (connectivity, lengths) = surface.build()?;
    Ok(ricci_mesh::intrinsic(Arc::new(connectivity), Arc::new(lengths), surface.geometry))
}

/// The approximate number of faces of a sample surface, by the formulas of the header.
fn faces_of(shape: SampleKind, [n, m, genus]: [usize; 3]) -> usize {
    let square = n.saturating_mul(n);
    let cut = |times: usize| 4_usize.saturating_pow(times.min(32) as u32);
    match shape {
        SampleKind::Sphere | SampleKind::Ellipsoid => square.saturating_mul(20),
        SampleKind::Disk => square.saturating_mul(6),
        SampleKind::Annulus | SampleKind::Torus | SampleKind::Knot | SampleKind::FlatTorus => {
            n.saturating_mul(m).saturating_mul(2)
        }
        SampleKind::Genus => genus.saturating_mul(6).saturating_mul(square).saturating_mul(16),
        SampleKind::Bolza | SampleKind::Pants => cut(n).saturating_mul(16),
        SampleKind::OneVertex | SampleKind::TwoVertex => genus.saturating_mul(4),
        SampleKind::TwoTriangles => 2,
        SampleKind::Hyperelliptic => square.saturating_mul(40),
        // Genus and boundary loops of a surface with no more curves.
        SampleKind::FenchelNielsen => cut(n).saturating_mul(genus.saturating_add(m).saturating_mul(32)),
    }
}

/// A reserve for a sample surface. One with more faces than an index can count gets none: the library refuses it.
fn room_for(shape: SampleKind, sizes: [usize; 3]) -> Outcome<memory::Reserve> {
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
        let _reserve =
            room_for(shape, [n, if shape == SampleKind::FenchelNielsen { n_points } else { m }, genus])?;
        ricci_mesh::from_soup(match shape {
            SampleKind::Sphere => shapes::icosphere(n)?,
            SampleKind::Ellipsoid => shapes::ellipsoid([a, b, c], n)?,
            SampleKind::Disk => shapes::disk(n)?,
            SampleKind::Annulus => shapes::annulus(a, b, n, m)?,
            SampleKind::Torus => shapes::torus(a, b, n, m)?,
            SampleKind::Genus => shapes::tapered_genus(genus, n, if a == 0.0 { 1.0 } else { a })?,
            SampleKind::Knot => TorusKnot { p, q, big: a, small: b }.torus(c, n, m)?,
            SampleKind::FlatTorus => return intrinsic(shapes::flat_torus([a, b], n, m)?),
            SampleKind::Bolza => return intrinsic(shapes::bolza(n)?),
            SampleKind::OneVertex => return intrinsic(shapes::one_vertex(genus)?),
            SampleKind::TwoVertex => return intrinsic(shapes::two_vertex(genus)?),
            SampleKind::TwoTriangles => return intrinsic(shapes::two_triangle_sphere()),
            SampleKind::Pants => return intrinsic(shapes::pants([a, b, c], n)?),
            SampleKind::Hyperelliptic => {
                return intrinsic(shapes::hyperelliptic(&branch_points(points, n_points)?, n)?);
            }
            SampleKind::FenchelNielsen => {
                return intrinsic(
                    shapes::fenchel_nielsen(&coordinates(genus, points, n_points)?, n)?.surface,
                );
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
            ShapeChange::Punch => soup = shapes::punch(&soup, count)?,
            ShapeChange::Grade => shapes::grade(&mut soup, vertex, count)?,
            ShapeChange::Caps => shapes::slivers(&mut soup, Sliver::Cap, count, amount, seed)?,
            ShapeChange::Needles => shapes::slivers(&mut soup, Sliver::Needle, count, amount, seed)?,
            ShapeChange::Noise => shapes::noise(&mut soup, amount, seed)?,
            ShapeChange::Invert => shapes::invert(&mut soup, centre, amount)?,
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
