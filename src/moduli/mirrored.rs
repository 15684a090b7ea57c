//! Moduli of annuli and quadrilaterals with proven bounds: their mirror images make them tori.
//!
//! An annulus and its mirror image, glued along both loops, are a torus; a disk with four corners and its images in the first and third side, in
//! the second and fourth, and in both, are another one. Reflections are conformal, so harmonic forms of the torus are mirror images of
//! themselves, and the extremal length of a loop of it, `|p + q Π|² / Im Π` for `p a + q b` and the period Π, gives the modulus.

use super::bounds::{BoundsOptions, PeriodBounds, period_bounds};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Enclosure;
use crate::harmonic::{Domain, FormsOptions, HarmonicForms};
use crate::mesh::shapes::IntrinsicSurface;
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::metric::Surface;
use std::collections::HashMap;

/// The extremal distance of the loops of an annulus, or of the first and third side of a quadrilateral: a number between two bounds.
#[derive(Debug, Clone)]
pub struct ModulusBounds {
    /// The bounds of the modulus of the polyhedral surface with exactly the given lengths. It is height over base: of an annulus the distance
    /// of its loops over the length of one, of a quadrilateral the second side over the first, in its conformal image.
    pub interval: [f64; 2],
    /// The period matrix of the torus of mirror images, whose gap is the relative width.
    pub torus: PeriodBounds,
}

/// How a surface is reflected.
struct Mirrors {
    /// Number of copies: 2 or 4.
    n_copies: u32,
    /// Per edge the bit of the copies' numbers that changes across it; 0 inside.
    bit: PerEdge<u32>,
    /// Half-edges with copies that follow each other as a loop.
    around: Vec<(HalfedgeId, u32)>,
    /// The modulus is 1 over this number times the extremal length of that loop.
    share: f64,
}

/// The torus of the images, with the number of every edge of every copy.
struct Torus {
    surface: IntrinsicSurface,
    /// Per copy and edge its number, from 1.
    numbers: Vec<PerEdge<i32>>,
}

/// Bounds of the modulus of an annulus, or of the quadrilateral of a disk with four `corners`, from the first on with the surface on their
/// left. What [`period_bounds`] says of the torus of mirror images holds of them, rounding included, for the polyhedron with exactly the given
/// lengths (chords of lengths in H² and S²).
///
/// # Errors
/// [`Error::Argument`] for a surface that is neither, or for corners that are not four vertices of the boundary; those of [`HarmonicForms::new`]
/// and [`period_bounds`].
pub fn modulus_bounds(
    surface: &Surface,
    corners: &[VertexId],
    options: &BoundsOptions,
    control: &Control,
) -> Result<ModulusBounds> {
    let mirrors = Mirrors::new(surface.mesh(), corners)?;
    let torus = mirrors.torus(surface);
    let (mesh, lengths) = torus.surface.build()?;
    let closed = Surface::intrinsic(mesh, lengths, surface.geometry())?;
    // On its own triangulation, so that no length is rounded by a flip.
    let domain = Domain::rigid(&closed)?;
    let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &control.part(0.0, 0.3))?;
    let bounds = period_bounds(&forms, options, &control.part(0.3, 1.0))?;
    // The loop is p a + q b.
    let [p, q] = [0, 1].map(|k| {
        let mut values = PerEdge::filled(closed.mesh().n_edges(), 0);
        forms.cochains[k].0.iter().for_each(|&(e, x)| values[e] = x);
        let along = |&(h, copy): &(HalfedgeId, u32)| {
            let value = values[EdgeId(torus.numbers[copy as usize][h.edge()] as u32 - 1)];
            if h.0 & 1 == 0 { value } else { -value }
        };
        f64::from(mirrors.around.iter().map(along).sum::<i32>())
    });
    let [x, y] = bounds.matrix[0][0].map(Enclosure::from);
    let real = Enclosure::from(p) + x * q.into();
    let imaginary = y * q.into();
    let extremal = (real * real + imaginary * imaginary) / y * mirrors.share.into();
    // Extremal lengths change by at most the factor d.
    let d = Enclosure::from(1.0) + bounds.gap.into();
    let one = Enclosure::from(1.0);
    let interval = [(one / (extremal * d)).lower(), (d / extremal).upper()];
    Ok(ModulusBounds { interval, torus: bounds })
}

impl Mirrors {
    fn new(mesh: &Mesh, corners: &[VertexId]) -> Result<Mirrors> {
        let loops = mesh.boundary_loops();
        let mut bit = PerEdge::filled(mesh.n_edges(), 0);
        if mesh.euler() == 0 && loops.len() == 2 && corners.is_empty() {
            loops.iter().flatten().for_each(|h| bit[h.edge()] = 1);
            let around = mesh.boundary_from(loops[0][0].twin()).into_iter().map(|h| (h, 0)).collect();
            return Ok(Mirrors { n_copies: 2, bit, around, share: 2.0 });
        }
        if mesh.euler() != 1 || loops.len() != 1 || corners.len() != 4 {
            let (euler, n) = (mesh.euler(), loops.len());
            let value = format!("with χ = {euler}, {n} boundary loops and {} corners", corners.len());
            let need = "an annulus without corners or a disk with four, to have a modulus";
            return Err(Error::argument("surface", value, need));
        }
        let missing = |v: VertexId| Error::argument("corner", v, "a vertex of the boundary, named once");
        let first = loops[0].iter().map(|h| h.twin()).find(|&h| mesh.origin(h) == corners[0]);
        let path = mesh.boundary_from(first.ok_or_else(|| missing(corners[0]))?);
        for (k, v) in corners.iter().enumerate() {
            if corners[..k].contains(v) || !path.iter().any(|&h| mesh.origin(h) == *v) {
                return Err(missing(*v));
            }
        }
        let (mut side, mut base) = (0, Vec::new());
        for &h in &path {
            side += u32::from(corners.contains(&mesh.origin(h)));
            // Across the first and third side the second bit changes.
            bit[h.edge()] = if side % 2 == 1 { 2 } else { 1 };
            if side == 1 {
                base.push(h);
            }
        }
        // Along the first side, and back along its image in the second.
        let there = base.iter().map(|&h| (h, 0));
        let around = there.chain(base.iter().rev().map(|h| (h.twin(), 1))).collect();
        Ok(Mirrors { n_copies: 4, bit, around, share: 1.0 })
    }

    /// The copies glued along their boundaries, those with an odd number of reflections turned over.
    fn torus(&self, surface: &Surface) -> Torus {
        let (mesh, lengths) = (surface.mesh(), surface.lengths());
        let n = mesh.n_vertices() as u32;
        let mut corners = UnionFind::new((self.n_copies * n) as usize);
        let (mut numbers, mut all) = (Vec::<PerEdge<i32>>::new(), Vec::new());
        for copy in 0..self.n_copies {
            let mut of_copy = PerEdge::filled(mesh.n_edges(), 0);
            for e in mesh.edges() {
                let other = copy ^ self.bit[e];
                mesh.ends(e).into_iter().for_each(|v| {
                    corners.join(copy * n + v.0, other * n + v.0);
                });
                of_copy[e] = if other < copy {
                    numbers[other as usize][e]
                } else {
                    all.push(lengths[e]);
                    all.len() as i32
                };
            }
            numbers.push(of_copy);
        }
        let mut names: HashMap<u32, u32> = HashMap::new();
        let mut vertex = |copy: u32, v: VertexId| {
            let next = names.len() as u32;
            *names.entry(corners.root(copy * n + v.0)).or_insert(next)
        };
        let (mut faces, mut face_edges) = (Vec::new(), Vec::new());
        for copy in 0..self.n_copies {
            for f in mesh.faces() {
                let [a, b, c] = mesh.face_vertices(f).map(|v| vertex(copy, v));
                let number = |e: i32| numbers[copy as usize][EdgeId(e.unsigned_abs() - 1)] * e.signum();
                let [bc, ca, ab] = mesh.face_edges(f).map(number);
                let is_turned = copy.count_ones() % 2 == 1;
                faces.push(if is_turned { [a, c, b] } else { [a, b, c] });
                face_edges.push(if is_turned { [-bc, -ab, -ca] } else { [bc, ca, ab] });
            }
        }
        let n_vertices = names.len();
        let geometry = surface.geometry();
        Torus { surface: IntrinsicSurface { n_vertices, faces, face_edges, lengths: all, geometry }, numbers }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod tests {
    use super::*;
    use crate::canonical::{Boundary, BoundaryCorner, Corners, QuotientOptions, uniformize_quotient};
    use crate::geometry::Space;
    use crate::mesh::io::Soup;
    use crate::mesh::shapes;

    fn bounds(surface: &Surface, corners: &[u32], width: f64) -> ModulusBounds {
        let corners: Vec<VertexId> = corners.iter().map(|&v| VertexId(v)).collect();
        let options = BoundsOptions { width, ..BoundsOptions::default() };
        modulus_bounds(surface, &corners, &options, &Control::new()).unwrap()
    }

    /// An n × m grid of squares, or of those of the lower left L, with the numbers of the corners of grid places.
    fn grid(
        n: usize,
        m: usize,
        wanted: impl Fn(usize, usize) -> bool,
    ) -> (Surface, impl Fn(usize, usize) -> u32) {
        let mut names = HashMap::new();
        let mut soup = Soup::default();
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).filter(|&(i, j)| wanted(i, j)) {
            let mut corner = |di: usize, dj: usize| {
                let at = (i + di, j + dj);
                *names.entry(at).or_insert_with(|| {
                    soup.positions.push([at.0 as f64, at.1 as f64, 0.0]);
                    soup.positions.len() as u32 - 1
                })
            };
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            soup.faces.extend([[a, b, c], [a, c, d]]);
        }
        (Surface::from_soup(&soup).unwrap(), move |i, j| names[&(i, j)])
    }

    #[test]
    fn rectangles_and_cylinders_have_their_moduli() {
        for (n, m) in [(3, 2), (2, 5), (4, 4)] {
            let (surface, at) = grid(n, m, |_, _| true);
            let corners = [at(0, 0), at(n, 0), at(n, m), at(0, m)];
            let found = bounds(&surface, &corners, 1e-9);
            let modulus = m as f64 / n as f64;
            let [low, high] = found.interval;
            assert!(low <= modulus && modulus <= high && high - low < 1e-12, "{n} × {m}: {low} {high}");
            // From the second corner on base and height change places.
            let turned = [corners[1], corners[2], corners[3], corners[0]];
            let [low, high] = bounds(&surface, &turned, 1e-9).interval;
            assert!(low <= 1.0 / modulus && 1.0 / modulus <= high, "{n} × {m}: {low} {high}");
        }
    }

    #[test]
    fn corners_of_an_l_have_the_modulus_of_symmetry() {
        // The L of three unit squares is symmetric about its diagonal, which exchanges the sides of these corners: the modulus is 1. From
        // (2, 0), (2, 1), (1, 2), (0, 2) that of [PS10] has no simple value, and finer bounds lie within wider ones.
        let (surface, at) = grid(2, 2, |i, j| i == 0 || j == 0);
        let symmetric = [at(0, 0), at(2, 0), at(1, 1), at(0, 2)];
        let mut before: Option<[f64; 2]> = None;
        for width in [1e-1, 1e-2, 1e-3, 1e-5] {
            let [low, high] = bounds(&surface, &symmetric, width).interval;
            assert!(
                low <= 1.0 && 1.0 <= high && high / low <= (1.0 + width) * (1.0 + width) * 1.000_001,
                "{low} {high}"
            );
            let other = bounds(&surface, &[at(2, 0), at(2, 1), at(1, 2), at(0, 2)], width).interval;
            if let Some(before) = before {
                assert!(other[0] <= before[1] && before[0] <= other[1], "{before:?} {other:?}");
            }
            before = Some(other);
        }
    }

    /// The polygon inside an annulus between circles, and one around it, have moduli on both sides of log(R/r)/2π.
    #[test]
    fn polygonal_annuli_converge_to_round_ones() {
        let truth = (2.5f64).ln() / std::f64::consts::TAU;
        let mut last = f64::INFINITY;
        for n in [16, 32, 64] {
            let soup = shapes::annulus(0.4, 1.0, n / 4, 2 * n).unwrap();
            let [low, high] = bounds(&Surface::from_soup(&soup).unwrap(), &[], 1e-5).interval;
            let off = (0.5 * (low + high) - truth).abs();
            assert!(high - low < 3e-5 * truth && off < 0.3 * last, "{n}: {low} {high} {off:e}");
            last = off;
        }
    }

    /// The flow's modulus is that of a discrete conformal class, which comes nearer to the interval as the mesh is refined.
    #[test]
    fn the_modulus_of_the_flow_is_near_the_interval() {
        let mut last = f64::INFINITY;
        for n in [6, 12, 24] {
            let surface = Surface::from_soup(&shapes::disk(n).unwrap()).unwrap();
            let mesh = surface.mesh();
            let path = mesh.boundary_from(mesh.boundary_loops()[0][0].twin());
            let at = |share: f64| mesh.origin(path[(share * path.len() as f64) as usize]);
            let corners = [at(0.0), at(0.2), at(0.5), at(0.7)];
            let named = corners.map(|vertex| BoundaryCorner { vertex, angle: None }).to_vec();
            let options =
                QuotientOptions { boundary: Boundary::Straight(Corners::At(named)), ..Default::default() };
            let flat = uniformize_quotient(&surface, &options, &Control::new())
                .unwrap()
                .extremal_distance()
                .unwrap();
            let [low, high] = bounds(&surface, &corners.map(|v| v.0), 1e-4).interval;
            let off = (flat / (0.5 * (low + high)) - 1.0).abs();
            assert!(off < 0.7 * last + 1e-4 && off < 0.05, "{n}: {low} {high} {flat}");
            last = off;
        }
    }

    #[test]
    fn surfaces_without_a_modulus_are_refused() {
        let disk = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
        let (options, control) = (BoundsOptions::default(), Control::new());
        let with = |corners: &[u32]| {
            let corners: Vec<VertexId> = corners.iter().map(|&v| VertexId(v)).collect();
            modulus_bounds(&disk, &corners, &options, &control)
        };
        assert!(matches!(with(&[]), Err(Error::Argument { .. })));
        assert!(matches!(with(&[0, 20, 25, 30]), Err(Error::Argument { .. })));
        assert!(matches!(with(&[20, 20, 25, 30]), Err(Error::Argument { .. })));
        assert_eq!(disk.geometry(), Space::E2);
    }
}
