//! A bracket of the Teichmüller distance between two surfaces: the least quasi-conformal dilatation K of the maps in the class of a
//! matching, between two numbers. The distance is `½ log K`.
//!
//! From above, the largest dilatation of the map itself, taken as linear on the triangles of the common subdivision, or of the map by the numbers of
//! vertices where both surfaces have one triangulation. From below, harmonic forms:
//! a map of dilatation K changes energies at most by the factor K, so K is at least the largest ratio of energies of classes that correspond,
//! the largest eigenvalue of one energy matrix against the other; of annuli and quadrilaterals the ratio of their moduli \[Ahl06\].

use super::energy_ratio::{ROUNDING, ratio_of_energies};
use super::quality::dilatation;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{cross, norm, sub};
use crate::harmonic::Domain;
use crate::mesh::{FaceId, Mesh, Point, VertexId};
use crate::metric::common_subdivision::CommonSubdivision;
use crate::metric::{Surface, lengths::face_lengths};
use crate::moduli::{BoundsOptions, modulus_bounds};

/// What the lower bound is proven by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LowerBoundKind {
    /// Period matrices of closed surfaces, or of the doubles of surfaces with boundary.
    PeriodMatrices,
    /// Moduli of annuli, or of disks with four landmarks on the boundary, whose maps keep these.
    Moduli,
    /// Nothing is known of this topology: the bound is 1.
    None,
}

/// Two numbers between which the least dilatation of the maps of a class lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DilatationBracket {
    /// No map of the class has a smaller dilatation.
    pub lower: f64,
    /// The dilatation of a map of the class, the largest over the pieces.
    pub upper: f64,
    /// True if this map is the one that is linear on the faces of one triangulation on both surfaces, whose dilatation is smaller than that of
    /// the matching: it brings loops to homologous ones.
    pub by_numbers: bool,
    /// The dilatation that 99 % of the source's area stay below.
    pub most: f64,
    /// Number of pieces that rounding leaves without a shape, and their share of the source's area: they do not count in `upper`.
    pub left_out: usize,
    /// Their share of the area.
    pub left_out_area: f64,
    /// What proves the lower bound.
    pub kind: LowerBoundKind,
    /// The relative widths of the period matrices or moduli of source and target.
    pub gaps: [f64; 2],
}

/// Height of a piece over the longest side of its face, on either surface, below which it has no shape in f64.
const THIN: f64 = 1e-6;
/// Share of the area that [`DilatationBracket::most`] is for.
const MOST: f64 = 0.99;

/// The bracket of a map between two surfaces, by the common subdivision of both ([`super::CommonDomain::overlay`]). Triangles are measured by their
/// lengths, in H² and S² by their chords. `landmarks`: pairs of vertices that the maps of the class bring to each other.
///
/// # Errors
/// Those of [`crate::moduli::period_bounds`] and [`modulus_bounds`]; [`crate::Error::Matching`] for the subdivision of other surfaces.
pub fn dilatation_bracket(
    surfaces: [&Surface; 2],
    overlay: &CommonSubdivision,
    landmarks: &[[VertexId; 2]],
    options: &BoundsOptions,
    control: &Control,
) -> Result<DilatationBracket> {
    overlay.check_sides(surfaces.map(|surface| &**surface.mesh()))?;
    // On their own triangulations, whose edges those of the subdivision run along.
    let domains = [Domain::rigid(surfaces[0])?, Domain::rigid(surfaces[1])?];
    let mut bracket = above(domains.each_ref(), overlay);
    let by_numbers = above_by_numbers(domains.each_ref(), landmarks);
    let mesh = surfaces[0].mesh();
    if let Some(corners) = corners(mesh, landmarks) {
        let of = |s: usize| {
            let control = control.part(0.5 * s as f64, 0.5 * s as f64 + 0.5);
            modulus_bounds(surfaces[s], &corners[s], options, &control)
        };
        let [a, b] = [of(0)?, of(1)?];
        let lower = (a.interval[0] / b.interval[1]).max(b.interval[0] / a.interval[1]) * (1.0 - ROUNDING);
        let gaps = [a.torus.gap, b.torus.gap];
        bracket = DilatationBracket { lower, kind: LowerBoundKind::Moduli, gaps, ..bracket };
    } else if mesh.genus() > 0 || mesh.boundary_loops().len() > 1 {
        let found = ratio_of_energies(surfaces, overlay, options, control)?;
        let (lower, gaps) = (found.ratio, found.gaps);
        bracket = DilatationBracket { lower, kind: LowerBoundKind::PeriodMatrices, gaps, ..bracket };
        if let Some(other) = by_numbers.filter(|other| found.keeps_loops && other.upper < bracket.upper) {
            bracket = DilatationBracket { upper: other.upper, most: other.most, ..bracket };
            (bracket.left_out, bracket.left_out_area, bracket.by_numbers) = (0, 0.0, true);
        }
    }
    bracket.lower = bracket.lower.max(1.0);
    Ok(bracket)
}

/// The corners of both quadrilaterals of a disk with four landmarks on its boundary, in the order of the source's boundary; no corners for an
/// annulus; `None` for other surfaces.
fn corners(mesh: &Mesh, landmarks: &[[VertexId; 2]]) -> Option<[Vec<VertexId>; 2]> {
    let loops = mesh.boundary_loops();
    if mesh.euler() == 0 && loops.len() == 2 && landmarks.is_empty() {
        return Some([Vec::new(), Vec::new()]);
    }
    if mesh.euler() != 1 || loops.len() != 1 || landmarks.len() != 4 {
        return None;
    }
    let path = mesh.boundary_from(loops[0][0].twin());
    let place = |v: VertexId| path.iter().position(|&h| mesh.origin(h) == v);
    let mut placed: Vec<(usize, [VertexId; 2])> =
        landmarks.iter().filter_map(|pair| Some((place(pair[0])?, *pair))).collect();
    placed.sort_unstable();
    (placed.len() == 4).then(|| [0, 1].map(|s| placed.iter().map(|(_, pair)| pair[s]).collect()))
}

/// The corners of a face in the plane, and the length of its longest side.
fn flat_face(domain: &Domain, f: FaceId) -> ([Point; 3], f64) {
    let [a, b, c] = face_lengths(domain.mesh(), domain.lengths(), f);
    let x = ((b - a) * (b + a) + c * c) / (2.0 * c);
    let y = ((b - x) * (b + x)).max(0.0).sqrt();
    ([[0.0; 3], [c, 0.0, 0.0], [x, y, 0.0]], a.max(b).max(c))
}

/// The dilatations of the pieces, and what rounding leaves of them.
fn above(domains: [&Domain; 2], overlay: &CommonSubdivision) -> DilatationBracket {
    let (mut shapes, mut total, mut thin, mut thin_area) = (Vec::new(), 0.0, 0, 0.0);
    for f in overlay.mesh.faces() {
        let sides = [0, 1].map(|s| {
            let (corners, longest) = flat_face(domains[s], overlay.faces[s][f]);
            let at = |w: [f64; 3]| std::array::from_fn(|i| (0..3).map(|k| w[k] * corners[k][i]).sum());
            let piece: [Point; 3] = overlay.barycentric(s, f).map(at);
            let edges = [0, 1, 2].map(|k| sub(piece[(k + 1) % 3], piece[k]));
            let double_area = norm(cross(edges[0], edges[1]));
            let most = edges.map(norm).into_iter().fold(f64::MIN_POSITIVE, f64::max);
            (piece, double_area, double_area / most >= THIN * longest)
        });
        let [(own, area, is_wide), (image, _, is_image_wide)] = sides;
        total += area;
        if is_wide && is_image_wide {
            shapes.push((dilatation(own, image), area));
        } else {
            (thin, thin_area) = (thin + 1, thin_area + area);
        }
    }
    let (upper, most) = largest(shapes, total);
    DilatationBracket {
        lower: 1.0,
        upper,
        most,
        by_numbers: false,
        left_out: thin,
        left_out_area: thin_area / total.max(f64::MIN_POSITIVE),
        kind: LowerBoundKind::None,
        gaps: [0.0; 2],
    }
}

/// The largest of some dilatations with areas, and the one that [`MOST`] of the area stays below.
fn largest(mut shapes: Vec<(f64, f64)>, total: f64) -> (f64, f64) {
    shapes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut below = 0.0;
    let most = shapes.iter().find(|(_, area)| {
        below += area;
        below >= MOST * total
    });
    let upper = shapes.last().map_or(f64::INFINITY, |shape| shape.0);
    (upper, most.map_or(upper, |shape| shape.0))
}

/// Dilatations of the map that is linear on the faces of one triangulation on both surfaces.
struct NumberedMap {
    upper: f64,
    most: f64,
}

/// The map that brings every vertex to that of the same number, of surfaces with one triangulation and without landmarks.
fn above_by_numbers(domains: [&Domain; 2], landmarks: &[[VertexId; 2]]) -> Option<NumberedMap> {
    let [source, target] = domains;
    if source.mesh() != target.mesh() || landmarks.iter().any(|pair| pair[0] != pair[1]) {
        return None;
    }
    let shape = |f: FaceId| {
        let (own, image) = (flat_face(source, f).0, flat_face(target, f).0);
        (dilatation(own, image), source.face_areas()[f])
    };
    let shapes: Vec<(f64, f64)> = source.mesh().faces().map(shape).collect();
    let total = shapes.iter().map(|shape| shape.1).sum();
    let (upper, most) = largest(shapes, total);
    Some(NumberedMap { upper, most })
}
