//! A bracket of the Teichmüller distance between two surfaces: the least quasi-conformal dilatation K of the maps in the class of a
//! matching, between two numbers. The distance is `½ log K`.
//!
//! From above, the largest dilatation of the map itself, taken as linear on the triangles of the common subdivision, or of the map by the numbers of
//! vertices where both surfaces have one triangulation. From below, harmonic forms:
//! a map of dilatation K changes energies at most by the factor K, so K is at least the largest ratio of energies of classes that correspond,
//! the largest eigenvalue of one energy matrix against the other; of annuli and quadrilaterals the ratio of their moduli \[Ahl06\].

use super::quality::dilatation;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{cross, norm, sub};
use crate::harmonic::{Domain, FormsOptions, HarmonicForms};
use crate::linalg::dense::{cholesky, symmetric_eigenvalues};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace, Point, VertexId};
use crate::metric::common_subdivision::CommonSubdivision;
use crate::metric::{Surface, lengths::face_lengths};
use crate::moduli::{BoundsOptions, PeriodBounds, modulus_bounds, parts_of_edges, period_bounds};

/// What the lower bound is proven by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LowerBoundKind {
    /// Period matrices of closed surfaces.
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
/// Largest distance of an integral from a whole number.
const WHOLE: f64 = 1e-3;
/// Relative rounding of eigenvalues.
const ROUNDING: f64 = 1e-12;

/// The bracket of a map between two surfaces, by the common subdivision of both ([`super::CommonDomain::overlay`]). Triangles are measured by their
/// lengths, in H² and S² by their chords. `landmarks`: pairs of vertices that the maps of the class bring to each other.
///
/// # Errors
/// Those of [`period_bounds`] and [`modulus_bounds`]; [`Error::Matching`] for the subdivision of other surfaces.
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
    if mesh.is_closed() && mesh.genus() > 0 {
        let found = ratio_of_energies(domains.each_ref(), overlay, options, control)?;
        let (lower, gaps) = (found.ratio, found.gaps);
        bracket = DilatationBracket { lower, kind: LowerBoundKind::PeriodMatrices, gaps, ..bracket };
        if let Some(other) = by_numbers.filter(|other| found.keeps_loops && other.upper < bracket.upper) {
            bracket = DilatationBracket { upper: other.upper, most: other.most, ..bracket };
            (bracket.left_out, bracket.left_out_area, bracket.by_numbers) = (0, 0.0, true);
        }
    } else if let Some(corners) = corners(mesh, landmarks) {
        let of = |s: usize| {
            let control = control.part(0.5 * s as f64, 0.5 * s as f64 + 0.5);
            modulus_bounds(surfaces[s], &corners[s], options, &control)
        };
        let [a, b] = [of(0)?, of(1)?];
        let lower = (a.interval[0] / b.interval[1]).max(b.interval[0] / a.interval[1]) * (1.0 - ROUNDING);
        let gaps = [a.torus.gap, b.torus.gap];
        bracket = DilatationBracket { lower, kind: LowerBoundKind::Moduli, gaps, ..bracket };
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

/// What energies of both surfaces prove.
struct EnergyRatio {
    ratio: f64,
    gaps: [f64; 2],
    /// True if both have one triangulation, and the map brings loops to homologous ones of the same edges.
    keeps_loops: bool,
}

/// The largest ratio, of either surface to the other, that energies of classes which correspond certainly have, and the gaps.
fn ratio_of_energies(
    domains: [&Domain; 2],
    overlay: &CommonSubdivision,
    options: &BoundsOptions,
    control: &Control,
) -> Result<EnergyRatio> {
    let of = |s: usize| -> Result<(HarmonicForms, PeriodBounds)> {
        let control = control.part(0.5 * s as f64, 0.5 * s as f64 + 0.5);
        let forms = HarmonicForms::new(domains[s], &FormsOptions::default(), &control.part(0.0, 0.3))?;
        let bounds = period_bounds(&forms, options, &control.part(0.3, 1.0))?;
        Ok((forms, bounds))
    };
    let [(forms, bounds), (others, other)] = [of(0)?, of(1)?];
    let classes = pulled_back(&forms, &others, domains[1].mesh(), overlay)?;
    // The energies of the classes on the source that those of the target's basis are pulled back to.
    let own = bounds.energies();
    let n = own.len();
    let through = |i: usize, j: usize| -> f64 {
        let row = |i: usize, l: usize| (0..n).map(|k| classes[i][k] * own[k][l]).sum::<f64>();
        (0..n).map(|l| row(i, l) * classes[j][l]).sum()
    };
    let source: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| through(i, j)).collect()).collect();
    let ratios = relative_eigenvalues(&source, &other.energies())?;
    let (least, largest) = (ratios[0], ratios[n - 1]);
    let blur = (1.0 + bounds.gap) * (1.0 + other.gap);
    let ratio = largest.max(1.0 / least) / blur * (1.0 - ROUNDING);
    let keeps_loops = domains[0].mesh() == domains[1].mesh() && classes == by_edges(&forms, &others);
    Ok(EnergyRatio { ratio, gaps: [bounds.gap, other.gap], keeps_loops })
}

/// Per class of the target its integrals over the edges of the loops of the source's basis, on one triangulation.
fn by_edges(forms: &HarmonicForms, others: &HarmonicForms) -> Vec<Vec<f64>> {
    let n = forms.domain.mesh().n_edges();
    let class = |cells: &[(EdgeId, i32)]| -> Vec<f64> {
        let mut values = PerEdge::filled(n, 0);
        cells.iter().for_each(|&(e, x)| values[e] = x);
        let along = |h: &HalfedgeId| if h.0 & 1 == 0 { values[h.edge()] } else { -values[h.edge()] };
        forms.basis.loops.iter().map(|path| f64::from(path.iter().map(along).sum::<i32>())).collect()
    };
    others.cochains.iter().map(|cochain| class(&cochain.0)).collect()
}

/// The eigenvalues of `a⁻¹ b`, ascending.
fn relative_eigenvalues(a: &[Vec<f64>], b: &[Vec<f64>]) -> Result<Vec<f64>> {
    let (lower, n) = (cholesky(a)?, a.len());
    // L⁻¹ b L⁻ᵀ, by forward substitution from both sides.
    let solve = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let mut x = rows;
        for i in 0..n {
            for j in 0..n {
                let sum: f64 = (0..i).map(|k| lower[i][k] * x[k][j]).sum();
                x[i][j] = (x[i][j] - sum) / lower[i][i];
            }
        }
        (0..n).map(|j| x.iter().map(|row| row[j]).collect()).collect()
    };
    symmetric_eigenvalues(&solve(solve(b.to_vec())))
}

/// Per class of the target the integrals of its pullback over the loops of the source's basis, whole numbers.
fn pulled_back(
    forms: &HarmonicForms,
    others: &HarmonicForms,
    target: &Mesh,
    overlay: &CommonSubdivision,
) -> Result<Vec<Vec<f64>>> {
    let parts = parts_of_edges(overlay, &overlay.mesh, &forms.basis.loops);
    let torn = || Error::Matching("loops of the source do not go to closed loops of the target".into());
    let class = |cells: &[(EdgeId, i32)]| -> Result<Vec<f64>> {
        let mut values = PerEdge::filled(target.n_edges(), 0);
        cells.iter().for_each(|&(e, x)| values[e] = x);
        let on = |h: HalfedgeId| f64::from(if h.0 & 1 == 0 { values[h.edge()] } else { -values[h.edge()] });
        let potential: PerFace<[f64; 3]> = PerFace::from_fn(target.n_faces(), |f| {
            let [ab, bc, _] = target.face_halfedges(f);
            [0.0, on(ab), on(ab) + on(bc)]
        });
        let integral = |path: &Vec<HalfedgeId>| -> Result<f64> {
            let along = |&part: &HalfedgeId| integral_along(overlay, &potential, part);
            let sum: f64 = path.iter().flat_map(|h| &parts[h]).map(along).sum();
            if (sum - sum.round()).abs() <= WHOLE { Ok(sum.round()) } else { Err(torn()) }
        };
        forms.basis.loops.iter().map(integral).collect()
    };
    others.cochains.iter().map(|cochain| class(&cochain.0)).collect()
}

/// The integral over a half-edge of the subdivision of the form that is the derivative of a linear function on every face of the target.
fn integral_along(overlay: &CommonSubdivision, potential: &PerFace<[f64; 3]>, part: HalfedgeId) -> f64 {
    let (mesh, sign, h) = match overlay.mesh.face(part) {
        Some(_) => (&overlay.mesh, 1.0, part),
        None => (&overlay.mesh, -1.0, part.twin()),
    };
    let Some(f) = mesh.face(h) else { return 0.0 };
    let k = mesh.face_halfedges(f).iter().position(|&side| side == h).unwrap_or(0);
    let places = overlay.barycentric(1, f);
    let at = |w: [f64; 3]| -> f64 { w.iter().zip(potential[overlay.faces[1][f]]).map(|(w, u)| w * u).sum() };
    sign * (at(places[(k + 1) % 3]) - at(places[k]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod tests {
    use super::*;
    use crate::geometry::Space;
    use crate::matching::{MatchOptions, match_surfaces};
    use crate::mesh::shapes;

    fn flat_torus(tau: [f64; 2], n: usize) -> Surface {
        let (mesh, lengths) = shapes::flat_torus(tau, n, n).unwrap().build().unwrap();
        Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
    }

    fn bracket(surfaces: [&Surface; 2], options: &MatchOptions) -> DilatationBracket {
        let control = Control::new();
        let found = match_surfaces(surfaces[0], surfaces[1], options, &control).unwrap();
        let overlay = found.domain.overlay(0, &control).unwrap();
        dilatation_bracket(surfaces, &overlay, &options.landmarks, &BoundsOptions::default(), &control)
            .unwrap()
    }

    /// The extremal map of flat tori is affine, and log K the hyperbolic distance of their moduli in the class of the map.
    #[test]
    fn flat_tori_have_the_distance_of_their_moduli() {
        for (a, b, m) in
            [([0.1, 1.1], [0.35, 1.4], 7), ([0.0, 1.0], [0.0, 3.0], 6), ([-0.3, 2.0], [0.3, 0.96], 5)]
        {
            let (source, target) = (flat_torus(a, 8), flat_torus(b, m));
            let found = bracket([&source, &target], &MatchOptions::default());
            println!("{a:?} {b:?}: {found:?}");
            assert!(found.lower > 1.0 && found.upper / found.lower < 1.0 + 1e-6, "{found:?}");
            // One of the distances between τ and the images of τ' under the modular group.
            let is_one = (-6..=6i32).flat_map(|p| (-6..=6).map(move |q| (p, q))).any(|(p, q)| {
                (-6..=6).flat_map(|r| (-6..=6).map(move |s| (r, s))).any(|(r, s): (i32, i32)| {
                    let [p, q, r, s] = [p, q, r, s].map(f64::from);
                    let (dx, dy) = (r * b[0] + s, r * b[1]);
                    let square = dx * dx + dy * dy;
                    let image = [((p * b[0] + q) * dx + p * b[1] * dy) / square, b[1] / square];
                    let chord =
                        ((a[0] - image[0]).powi(2) + (a[1] - image[1]).powi(2)) / (4.0 * a[1] * image[1]);
                    p * s - q * r == 1.0
                        && ((2.0 * chord.sqrt().asinh()).exp() / found.lower - 1.0).abs() < 1e-6
                })
            });
            assert!(is_one, "{a:?} {b:?}: {found:?}");
        }
    }

    /// Three squares in an L, cut into n × n cells of this size: the affine map between two is extremal, with the loops of both its classes.
    fn squares_in_an_l(width: f64, height: f64, n: usize) -> Surface {
        let (right, up) = ([1, 0, 2], [2, 1, 0]);
        let (mut faces, mut face_edges, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
        let mut edges = std::collections::HashMap::new();
        let mut corners = crate::mesh::union_find::UnionFind::new(3 * (n + 1) * (n + 1));
        let place = |i: usize, x: usize, y: usize| (i * (n + 1) * (n + 1) + x * (n + 1) + y) as u32;
        for i in 0..3 {
            for k in 0..=n {
                corners.join(place(i, n, k), place(right[i], 0, k));
                corners.join(place(i, k, n), place(up[i], k, 0));
            }
        }
        let mut names = std::collections::HashMap::new();
        for (i, x, y) in (0..3).flat_map(|i| (0..n).flat_map(move |x| (0..n).map(move |y| (i, x, y)))) {
            let mut vertex = |x: usize, y: usize| {
                let next = names.len() as u32;
                *names.entry(corners.root(place(i, x, y))).or_insert(next)
            };
            let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            let mut edge = |kind: usize, i: usize, x: usize, y: usize| {
                let length = [width, height, width.hypot(height)][kind] / n as f64;
                *edges.entry((kind, i, x, y)).or_insert_with(|| {
                    lengths.push(length);
                    lengths.len() as i32
                })
            };
            let east = if x + 1 == n { edge(1, right[i], 0, y) } else { edge(1, i, x + 1, y) };
            let north = if y + 1 == n { edge(0, up[i], x, 0) } else { edge(0, i, x, y + 1) };
            let [south, west, across] = [edge(0, i, x, y), edge(1, i, x, y), edge(2, i, x, y)];
            faces.extend([[a, b, c], [a, c, d]]);
            face_edges.extend([[east, -across, south], [-north, -west, across]]);
        }
        let given = shapes::IntrinsicSurface {
            n_vertices: names.len(),
            faces,
            face_edges,
            lengths,
            geometry: Space::E2,
        };
        let (mesh, lengths) = given.build().unwrap();
        Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
    }

    #[test]
    fn square_tiled_surfaces_have_the_dilatation_of_their_stretch() {
        for (n, k) in [(4, 1.5f64), (6, 2.0)] {
            let (square, long) = (squares_in_an_l(1.0, 1.0, n), squares_in_an_l(k.sqrt(), 1.0 / k.sqrt(), n));
            let options = BoundsOptions { width: 1e-4, ..BoundsOptions::default() };
            let control = Control::new();
            let found = match_surfaces(&square, &long, &MatchOptions::default(), &control).unwrap();
            let overlay = found.domain.overlay(0, &control).unwrap();
            let found = dilatation_bracket([&square, &long], &overlay, &[], &options, &control).unwrap();
            println!("{n}, {k}: {found:?}");
            assert!(found.by_numbers && (found.upper / k - 1.0).abs() < 1e-12, "{k}: {found:?}");
            assert!(found.lower <= k && found.lower > k / (1.0 + 2.5e-4), "{k}: {found:?}");
        }
    }

    #[test]
    fn an_inversion_of_a_surface_of_genus_2_has_the_distance_0() {
        let surface =
            |n: usize, ratio: f64| Surface::from_soup(&shapes::tapered_genus(2, n, ratio).unwrap()).unwrap();
        // An inversion is conformal: the distance is 0.
        let found = bracket([&surface(4, 1.0), &surface(4, 2.2)], &MatchOptions::default());
        assert!(found.lower < 1.0 + 1e-2 && found.upper > 1.0 && found.most < 1.1, "{found:?}");
    }

    #[test]
    fn round_annuli_have_the_ratio_of_their_moduli() {
        let mut last = f64::INFINITY;
        for n in [6, 12, 24] {
            let ring = |inner: f64, m: usize| {
                Surface::from_soup(&shapes::annulus(inner, 1.0, n, m).unwrap()).unwrap()
            };
            let found = bracket([&ring(0.5, 6 * n), &ring(0.3, 5 * n)], &MatchOptions::default());
            let truth = 0.3f64.ln() / 0.5f64.ln();
            println!("{n}: {found:?}, {truth}");
            assert!(found.lower <= found.upper && (found.lower / truth - 1.0).abs() < 0.02, "{found:?}");
            let width = found.upper / found.lower;
            assert!(width < last, "{n}: {width}");
            last = width;
        }
        assert!(last < 1.2, "{last}");
    }
}
