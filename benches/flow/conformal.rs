//! Times of flattening a disk by the flow, and by a linear least-squares conformal map with the same factoriser.

use crate::common::seconds;
use ricci::flow::{Flips, Options, Report, curvature_derivative, flow};
use ricci::geometry::Space;
use ricci::linalg::{Cholesky, Pattern, Symmetric};
use ricci::mesh::{Mesh, shapes};
use ricci::metric::Metric;
use ricci::{Class, Control, Surface, Target};

/// The measurements of a disk of one size.
pub struct Row {
    pub vertices: usize,
    /// The flow to a disk that is flat inside, without flips and layout.
    pub report: Report,
    /// Seconds of the linear map: assembling its matrix, one analysis, one factorisation, one solution.
    pub linear: [f64; 4],
    /// Conformal energy of the linear map over its area: 0 for a conformal map.
    pub energy: f64,
}

/// A round disk with a hill beside its middle.
fn hill(vertices: usize) -> Surface {
    let rings = (vertices as f64 / 3.0).sqrt() as usize;
    let mut soup = shapes::disk(rings).unwrap();
    for [x, y, z] in &mut soup.positions {
        *z = 0.4 * (-4.0 * ((*x - 0.3).powi(2) + *y * *y)).exp();
    }
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    Surface::from_soup(&soup).unwrap()
}

pub fn measure(vertices: usize) -> Row {
    let (surface, class, control) = (hill(vertices), Class::yamabe(Space::E2), Control::new());
    let options = Options { flips: Flips::Never, threads: 1, ..Options::default() };
    let solution = flow(surface.clone(), class, &Target::Boundary, &options, &control).unwrap();
    let report = solution.report().unwrap().clone();
    assert!(report.converged(), "{report:?}");
    let (linear, energy) = least_squares(surface.mesh(), &surface.initial(class).unwrap().metric);
    Row { vertices: surface.mesh().n_vertices(), report, linear, energy }
}

/// The least-squares conformal map of \[LPRM02\] with two vertices of the boundary held: half the Dirichlet energy of both coordinates
/// less the area of the image. Returns the seconds, and the remaining energy relative to that area.
fn least_squares(mesh: &Mesh, metric: &Metric) -> ([f64; 4], f64) {
    let along = &mesh.boundary_loops()[0];
    let held = [0, along.len() / 2].map(|k| mesh.origin(along[k]).index());
    // Unknowns: x and y of each vertex in turn, those held left out.
    let number: Vec<Option<u32>> = {
        let mut next = 0;
        let mut count = |v: usize| {
            let is_free = !held.contains(&v);
            next += if is_free { 2 } else { 0 };
            is_free.then(|| next - 2)
        };
        (0..mesh.n_vertices()).map(&mut count).collect()
    };
    let (assemble, entries) = seconds(|| {
        let laplacian = curvature_derivative(mesh, metric).unwrap();
        let both = laplacian.into_iter().flat_map(|(i, j, x)| {
            let [i, j] = [i, j].map(|v| v.index());
            [((i, 0), (j, 0), x), ((i, 1), (j, 1), x)]
        });
        // The area is ½ Σ (x_i y_j − x_j y_i) over the edges of the boundary, which its half-edges outside run along backwards.
        let area = along.iter().flat_map(|&h| {
            let [j, i] = [mesh.origin(h), mesh.tip(h)].map(|v| v.index());
            [((i, 0), (j, 1), -0.5), ((j, 0), (i, 1), 0.5)]
        });
        both.chain(area).collect::<Vec<_>>()
    });
    let unknown = |(v, k): (usize, u32)| number[v].map(|n| n + k);
    let (built, (pattern, values, mut x)) = seconds(|| {
        let free = |&(a, b, x): &((usize, u32), (usize, u32), f64)| Some((unknown(a)?, unknown(b)?, x));
        let pairs: Vec<(u32, u32)> = entries.iter().filter_map(free).map(|(i, j, _)| (i, j)).collect();
        let pattern = Pattern::new(2 * (mesh.n_vertices() - 2), &pairs).unwrap();
        let (mut values, mut right) = (vec![0.0; pattern.entries()], vec![0.0; pattern.size()]);
        for &(a, b, x) in &entries {
            match (unknown(a), unknown(b)) {
                (Some(i), Some(j)) => values[pattern.position(i as usize, j as usize).unwrap()] += x,
                // The second held vertex lies at (1, 0), the first at the origin.
                (Some(i), None) if b == (held[1], 0) => right[i as usize] -= x,
                (None, Some(j)) if a == (held[1], 0) => right[j as usize] -= x,
                _ => {}
            }
        }
        (pattern, values, right)
    });
    let (analyse, mut cholesky) = seconds(|| Cholesky::analyse(&pattern).unwrap());
    let matrix = Symmetric { pattern: &pattern, values: &values };
    let factor = seconds(|| cholesky.factor(matrix).unwrap()).0;
    let solve = seconds(|| cholesky.solve(&mut x)).0;
    let at = |(v, k): (usize, u32)| match unknown((v, k)) {
        Some(i) => x[i as usize],
        None => f64::from(u8::from((v, k) == (held[1], 0))),
    };
    let quadratic = |(a, b, w): &((usize, u32), (usize, u32), f64)| {
        (if a == b { 0.5 } else { 1.0 }) * w * at(*a) * at(*b)
    };
    let energy: f64 = entries.iter().map(quadratic).sum();
    let area: f64 = entries.iter().filter(|(a, b, _)| a.1 != b.1).map(quadratic).sum();
    ([assemble + built, analyse, factor, solve], energy / area.abs())
}
