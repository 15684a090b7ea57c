//! Bounds of surfaces whose period matrices are known: they contain the truth on random refinements.

use super::bounds::{BoundsOptions, PeriodBounds, period_bounds};
use super::elements::Degree;
use super::energy::upper_energies;
use super::finer::BisectedSurface;
use super::proof::{mean_period_matrix, proven_gap};
use super::solve::least_forms;
use crate::geometry::complex::Complex;
use crate::geometry::random::SplitMix64;
use crate::geometry::{Enclosure, Space};
use crate::harmonic::{Domain, FormsOptions, HarmonicForms};
use crate::linalg::dense::{cholesky, symmetric_eigenvalues};
use crate::mesh::shapes::{IntrinsicSurface, flat_torus};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, PerFace};
use crate::moduli::gap::{inverse, product, transposed};
use crate::{Control, Surface};
use std::f64::consts::PI;

/// Unit squares glued by permutations: square `right[i]` lies to the right of square i, `up[i]` above it.
fn square_tiled(right: &[usize], up: &[usize]) -> IntrinsicSurface {
    let n = right.len();
    let edge = |kind: usize, i: usize| (kind * n + i + 1) as i32;
    // Corners of square i counterclockwise from the lower left: 4 i, …, 4 i + 3.
    let mut corners = UnionFind::new(4 * n);
    for i in 0..n {
        for (mine, other) in [(1, 4 * right[i]), (2, 4 * right[i] + 3), (3, 4 * up[i]), (2, 4 * up[i] + 1)] {
            corners.join((4 * i + mine) as u32, other as u32);
        }
    }
    let roots: Vec<u32> = (0..4 * n as u32).map(|c| corners.root(c)).collect();
    let mut names = roots.clone();
    names.sort_unstable();
    names.dedup();
    let vertex = |c: usize| names.binary_search(&roots[c]).unwrap() as u32;
    let (mut faces, mut face_edges) = (Vec::new(), Vec::new());
    for i in 0..n {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| vertex(4 * i + k));
        faces.extend([[a, b, c], [a, c, d]]);
        face_edges.push([edge(1, right[i]), -edge(2, i), edge(0, i)]);
        face_edges.push([-edge(0, up[i]), -edge(1, i), edge(2, i)]);
    }
    let lengths = [vec![1.0; 2 * n], vec![2f64.sqrt(); n]].concat();
    IntrinsicSurface { n_vertices: names.len(), faces, face_edges, lengths, geometry: Space::E2 }
}

/// The regular 4g-gon in the plane with opposite sides glued, as a fan around its centre: one cone of (4g − 2)π.
fn polygon(genus: usize) -> IntrinsicSurface {
    let n = 4 * genus;
    let side = |k: usize| if k < n / 2 { k as i32 + 1 } else { -((k - n / 2) as i32 + 1) };
    let spoke = |k: usize| (n / 2 + k % n + 1) as i32;
    let face_edges = (0..n).map(|k| [side(k), -spoke(k + 1), spoke(k)]).collect();
    let lengths = [vec![2.0 * (PI / n as f64).sin(); n / 2], vec![1.0; n]].concat();
    IntrinsicSurface { n_vertices: 2, faces: vec![[0, 1, 1]; n], face_edges, lengths, geometry: Space::E2 }
}

fn forms_of(given: &IntrinsicSurface) -> HarmonicForms {
    let (mesh, lengths) = given.build().unwrap();
    let surface = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
    let control = Control::new();
    HarmonicForms::new(&Domain::new(&surface, &control).unwrap(), &FormsOptions::default(), &control).unwrap()
}

fn bounds_of(given: &IntrinsicSurface, options: &BoundsOptions) -> PeriodBounds {
    period_bounds(&forms_of(given), options, &Control::new()).unwrap()
}

/// The bounds on a triangulation as it is.
fn bounded(surface: &BisectedSurface) -> (Vec<Vec<Enclosure>>, Vec<Vec<Complex>>, f64) {
    let (mut surface, control, cotangents) = (surface.clone(), Control::new(), surface.cotangents());
    surface.take_centres(&cotangents);
    let (forms, _) = least_forms(&surface, &cotangents, &control).unwrap();
    let upper = upper_energies(&surface, &forms, &cotangents, &control).unwrap();
    let matrix = mean_period_matrix(&upper).unwrap();
    let gap = proven_gap(&matrix, &upper).unwrap();
    (upper, matrix, gap)
}

/// The matrix `(Y + X Y⁻¹ X, −X Y⁻¹; −Y⁻¹ X, Y⁻¹)` in the order a1, b1, ….
fn energies(periods: &[Vec<Complex>]) -> Vec<Vec<f64>> {
    let g = periods.len();
    let part = |k: usize| -> Vec<Vec<f64>> {
        periods.iter().map(|row| row.iter().map(|z| z[k]).collect()).collect()
    };
    let [x, y] = [part(0), part(1)];
    let frame = inverse(&cholesky(&y).unwrap());
    let of_y = product(&transposed(&frame), &frame);
    let slope = product(&x, &of_y);
    let square = product(&slope, &x);
    let entry = |i: usize, j: usize| match (i % 2, j % 2) {
        (0, 0) => y[i / 2][j / 2] + square[i / 2][j / 2],
        (0, _) => -slope[i / 2][j / 2],
        (_, 0) => -slope[j / 2][i / 2],
        _ => of_y[i / 2][j / 2],
    };
    (0..2 * g).map(|i| (0..2 * g).map(|j| entry(i, j)).collect()).collect()
}

/// The least and the largest t with `t a ⪯ b`, `b ⪯ t a`.
fn between(a: &[Vec<f64>], b: &[Vec<f64>]) -> [f64; 2] {
    let frame = inverse(&cholesky(a).unwrap());
    let seen = symmetric_eigenvalues(&product(&product(&frame, b), &transposed(&frame))).unwrap();
    [seen[0], seen[seen.len() - 1]]
}

fn below(random: &mut SplitMix64, n: usize) -> usize {
    (random.bits() % n as u64) as usize
}

/// Random midpoints, flips to Delaunay or not, and quadratic terms on some edges.
fn shuffle(surface: &mut BisectedSurface, random: &mut SplitMix64) {
    for _ in 0..below(random, 12) {
        let e = EdgeId(below(random, surface.mesh.n_edges()) as u32);
        surface.halve(e);
        if below(random, 3) == 0 {
            surface.make_delaunay(&Control::new()).unwrap();
        }
    }
    if below(random, 2) == 0 {
        surface.is_curved.iter_mut().for_each(|is_curved| *is_curved = below(random, 2) == 0);
    }
}

/// Rounding of the f64 in which the truth is compared.
const ROUNDING: f64 = 1e-12;

/// A surface with its period matrix in the basis of its forms.
fn known() -> Vec<(&'static str, HarmonicForms, Vec<Vec<Complex>>)> {
    // By symmetry the mean of both bounds is the truth on the symmetric triangulations of regular polygons, on the torus of one vertex and
    // on the three squares of an L; the next test compares it with what is known of them.
    [
        ("torus", flat_torus([0.3, 1.2], 1, 1).unwrap()),
        ("L", square_tiled(&[1, 0, 2], &[2, 1, 0])),
        ("octagon", polygon(2)),
        ("12-gon", polygon(3)),
        ("16-gon", polygon(4)),
    ]
    .map(|(name, given)| {
        let forms = forms_of(&given);
        let matrix = bounded(&BisectedSurface::new(&forms).unwrap()).1;
        (name, forms, matrix)
    })
    .into()
}

/// Energies of integer classes, ascending: they do not depend on the basis.
fn least_energies(energies: &[Vec<f64>], many: usize) -> Vec<f64> {
    let n = energies.len();
    let mut all: Vec<f64> = (0..5usize.pow(n as u32))
        .map(|code| (0..n).map(|k| (code / 5usize.pow(k as u32) % 5) as f64 - 2.0).collect::<Vec<_>>())
        .map(|v| {
            (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| v[i] * energies[i][j] * v[j]).sum()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all[1..=many].to_vec()
}

#[test]
fn symmetric_meshes_have_the_period_matrices_of_their_curves() {
    for (name, _, matrix) in known() {
        let truth = match name {
            "torus" => vec![vec![[0.3, 1.2]]],
            "L" => vec![vec![[0.0, 2.0 / 3.0], [0.0, -1.0 / 3.0]], vec![[0.0, -1.0 / 3.0], [0.0, 5.0 / 3.0]]],
            "octagon" => {
                let points = [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
                let points = points.map(|[x, y]| num_complex::Complex64::new(x, y));
                let found = crate::geometry::hyperelliptic::period_matrix(&points).unwrap();
                found.iter().map(|row| row.iter().map(|z| [z.re, z.im]).collect()).collect()
            }
            _ => continue,
        };
        let [found, expected] = [matrix, truth].map(|m| least_energies(&energies(&m), 16));
        let off = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{name}: {found:?} {expected:?}");
    }
}

#[test]
fn bounds_contain_the_truth_on_random_refinements() {
    let mut random = SplitMix64::new(47);
    let mut closest = 0.0f64;
    for (name, forms, truth) in known() {
        let g_true = energies(&truth);
        for round in 0..200 {
            let mut surface = BisectedSurface::new(&forms).unwrap();
            shuffle(&mut surface, &mut random);
            let (upper, matrix, gap) = bounded(&surface);
            let upper: Vec<Vec<f64>> =
                upper.iter().map(|row| row.iter().map(|x| x.upper()).collect()).collect();
            let [least, _] = between(&g_true, &upper);
            assert!(least > 1.0 - ROUNDING, "{name} {round}: energies are {least} times the true ones");
            let [least, most] = between(&energies(&matrix), &g_true);
            let d = (1.0 + gap) * (1.0 + ROUNDING);
            assert!(least >= 1.0 / d && most <= d, "{name} {round}: {least} {most} {d}");
            for (i, row) in truth.iter().enumerate() {
                for (j, z) in row.iter().enumerate() {
                    let off = (z[0] - matrix[i][j][0]).hypot(z[1] - matrix[i][j][1]);
                    let radius = gap * (matrix[i][i][1] * matrix[j][j][1]).sqrt();
                    assert!(
                        off <= radius + ROUNDING,
                        "{name} {round}: entry {i}, {j} is off by {off}, {radius}"
                    );
                    closest = closest.max(off / (radius + ROUNDING));
                }
            }
        }
    }
    // The bound is of use: some entries use up a part of it.
    assert!(closest > 0.02, "{closest}");
}

#[test]
fn refinement_narrows_at_the_rates_of_linear_and_quadratic_functions() {
    for given in [square_tiled(&[1, 0, 2], &[2, 1, 0]), polygon(2)] {
        for (degree, least) in [(Degree::Linear, 0.85), (Degree::Quadratic, 1.6)] {
            let at = |most: usize| {
                let options = BoundsOptions { width: 0.0, degree, most_unknowns: Some(most) };
                let found = bounds_of(&given, &options);
                (found.n_unknowns as f64, found.gap)
            };
            let ((n, gap), (more, smaller)) = (at(400), at(6000));
            let rate = (gap / smaller).ln() / (more / n).ln();
            println!("{degree:?}: {n} unknowns {gap:.2e}, {more} unknowns {smaller:.2e}, rate {rate:.2}");
            assert!(rate > least, "{degree:?}: {n} {gap} {more} {smaller}: rate {rate}");
        }
    }
}

#[test]
fn widths_are_reached_and_lie_within_one_another() {
    // Squares in a row with others on top.
    for (right, up) in [
        (vec![1, 2, 3, 0, 4], vec![4, 1, 2, 3, 0]),
        (vec![1, 2, 3, 0, 5, 4], vec![4, 5, 2, 3, 0, 1]),
        (vec![1, 2, 3, 4, 5, 6, 7, 0], vec![2, 1, 4, 3, 6, 5, 0, 7]),
    ] {
        let forms = forms_of(&square_tiled(&right, &up));
        let [wide, narrow] = [1e-2, 1e-4].map(|width| {
            let options = BoundsOptions { width, ..BoundsOptions::default() };
            let found = period_bounds(&forms, &options, &Control::new()).unwrap();
            assert!(found.is_reached && found.gap <= width, "{right:?}: {}", found.gap);
            found
        });
        let [least, most] = between(&energies(&wide.matrix), &energies(&narrow.matrix));
        let limit = (1.0 + wide.gap) * (1.0 + narrow.gap);
        assert!(least >= 1.0 / limit && most <= limit, "{right:?}: {least} {most} {limit}");
    }
}

#[test]
fn shares_add_up_to_the_gap_of_all_classes() {
    for (name, forms, _) in known() {
        let mut surface = BisectedSurface::new(&forms).unwrap();
        shuffle(&mut surface, &mut SplitMix64::new(5));
        let (control, cotangents) = (Control::new(), surface.cotangents());
        let (closed, _) = least_forms(&surface, &cotangents, &control).unwrap();
        let gap = super::gap::Gap::new(&surface, &closed, &cotangents, &control).unwrap();
        let upper = upper_energies(&surface, &closed, &cotangents, &control).unwrap();
        let upper: Vec<Vec<f64>> =
            upper.iter().map(|row| row.iter().map(|x| x.nearest()).collect()).collect();
        let wedge = super::gap::wedge_in(&inverse(&cholesky(&upper).unwrap()));
        let expected = upper.len() as f64 - wedge.iter().flatten().map(|x| x * x).sum::<f64>();
        let shares: &PerFace<f64> = &gap.shares;
        let sum: f64 = shares.iter().sum();
        assert!((sum - expected).abs() < 1e-12 * (1.0 + expected), "{name}: {sum} {expected}");
    }
}
