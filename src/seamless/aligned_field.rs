//! Smooth fields of four directions in the faces of a surface, along features and near directions that are asked for \[KCPS13\].

use super::face_axes::FaceAxes;
use super::sectors::Sectors;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, conj, mul, norm, scale, unit};
use crate::geometry::random::SplitMix64;
use crate::geometry::triangle::{area_from, half_differences, plane_angles_with_weights};
use crate::geometry::vector::Vector;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge};
use crate::metric::Surface;
use crate::metric::lengths::face_lengths;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of inverse iteration towards the field of least energy where nothing is asked for.
const STEPS: usize = 30;
/// Shift of the energy, relative to its mean diagonal: the energy of a parallel field is 0.
const SHIFT: f64 = 1e-9;
/// Features of one face whose directions, as unit fourth powers, add up to less than this contradict each other: the first one counts.
const CONTRADICTION: f64 = 0.1;

/// A direction that the field is to be near in a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldGuide {
    /// The face.
    pub face: FaceId,
    /// The direction, radians counterclockwise from the first half-edge of the face. Turned by 90° it means the same.
    pub angle: f64,
    /// Its weight beside smoothness, positive: 1 is that of smoothness across an edge of an equilateral triangle, about.
    pub weight: f64,
}

/// A field of four directions at right angles, one in each face.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossField {
    /// Per face, the angle of one of the directions, radians counterclockwise from the first half-edge of the face.
    pub angles: PerFace<f64>,
    corner: PerHalfedge<f64>,
    direction: PerHalfedge<f64>,
}

impl CrossField {
    /// The smoothest field along the features and the boundary of a surface, near the directions that guides ask for. Along features it is
    /// exact, in faces with several that contradict each other a mean of them.
    ///
    /// # Errors
    /// [`Error::Argument`] for a feature or face that does not exist, and a weight or angle that is no finite number;
    /// [`Error::Factorisation`]; [`Error::Cancelled`].
    pub fn new(
        surface: &Surface,
        features: &[EdgeId],
        guides: &[FieldGuide],
        control: &Control,
    ) -> Result<CrossField> {
        CrossField::along(surface, &Sectors::new(surface.mesh(), features)?, guides, control)
    }

    /// [`CrossField::new`] along the features between these sectors.
    pub(super) fn along(
        surface: &Surface,
        sectors: &Sectors,
        guides: &[FieldGuide],
        control: &Control,
    ) -> Result<CrossField> {
        let frames = FaceFrames::new(surface);
        let energy = frames.energy(surface.mesh(), sectors, guides)?;
        control.check()?;
        let powers = energy.least(control)?;
        control.check()?;
        let angles = powers.iter().map(|[x, y]| y.atan2(*x) / 4.0).collect::<Vec<_>>().into();
        Ok(CrossField { angles, corner: frames.corner, direction: frames.direction })
    }

    /// Per face the direction of the field as a unit vector in space, 0 in a face without area; none for a surface without positions.
    pub fn in_space(&self, surface: &Surface) -> Option<PerFace<Vector>> {
        let (mesh, positions) = (surface.mesh(), surface.positions()?);
        let direction = |f: FaceId| {
            let places = mesh.face_vertices(f).map(|v| positions[v.index()]);
            FaceAxes::new(places).map_or([0.0; 3], |frame| frame.direction(self.angles[f]))
        };
        Some(PerFace::from_fn(mesh.n_faces(), direction))
    }

    /// The turn of the field across a half-edge, from its face to that of its twin, beside parallel transport: at most an eighth of a whole
    /// turn. 0 on the boundary.
    fn turn(&self, mesh: &Mesh, h: HalfedgeId) -> f64 {
        // Both halves of an edge turn by opposite angles, at exactly 45° by the same.
        let first = h.edge().halfedge();
        let (Some(f), Some(g)) = (mesh.face(first), mesh.face(first.twin())) else { return 0.0 };
        let carried = self.angles[f] - self.direction[first] + self.direction[first.twin()] + PI;
        let turn = nearest_to_zero(self.angles[g] - carried);
        if h == first { turn } else { -turn }
    }

    /// Per sector the number of right angles by which the field turns in it. The sum of 4 less these, of 2 less these between features, is
    /// 4χ of each piece.
    pub(super) fn right_angles(&self, mesh: &Mesh, sectors: &Sectors) -> Vec<i32> {
        let count = |(sector, &first): (usize, &HalfedgeId)| {
            let is_bounded = sectors.is_bounded(sector);
            let fan = if is_bounded { sectors.fan(mesh, first) } else { mesh.fan(mesh.origin(first)) };
            let total: f64 = fan.iter().map(|&h| self.corner[h]).sum();
            let crossed = if is_bounded { fan.len() - 1 } else { fan.len() };
            let turned: f64 = fan[..crossed].iter().map(|&h| self.turn(mesh, mesh.prev(h))).sum();
            let mut angle = total - turned;
            if is_bounded {
                // From the first feature to the field, and from the field to the last feature.
                let last = mesh.prev(fan[fan.len() - 1]);
                angle += self.offset(mesh, last) - self.offset(mesh, first);
            }
            (angle / FRAC_PI_2).round() as i32
        };
        sectors.beginnings(mesh).iter().enumerate().map(count).collect()
    }

    /// The angle from a side of a face to the nearest direction of the field there.
    fn offset(&self, mesh: &Mesh, h: HalfedgeId) -> f64 {
        mesh.face(h).map_or(0.0, |f| nearest_to_zero(self.angles[f] - self.direction[h]))
    }
}

/// An angle less a multiple of 90°, between −45° and 45°.
fn nearest_to_zero(angle: f64) -> f64 {
    angle - FRAC_PI_2 * (angle / FRAC_PI_2).round()
}

/// The fourth power of a direction.
fn fourth_power(angle: f64) -> Complex {
    let (sin, cos) = (4.0 * angle).sin_cos();
    [cos, sin]
}

/// Directions in the faces of a surface, as angles from their first half-edges.
struct FaceFrames {
    /// Per half-edge the angle at its origin, in its face.
    corner: PerHalfedge<f64>,
    /// Per half-edge its direction in its face.
    direction: PerHalfedge<f64>,
    area: PerFace<f64>,
    length: PerHalfedge<f64>,
}

impl FaceFrames {
    fn new(surface: &Surface) -> FaceFrames {
        let mesh = surface.mesh();
        let mut corner = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
        let (mut direction, mut length) = (corner.clone(), corner.clone());
        let mut area = PerFace::filled(mesh.n_faces(), 0.0);
        for f in mesh.faces() {
            let r = half_differences(face_lengths(mesh, surface.lengths(), f));
            let angles = plane_angles_with_weights(r).0.at;
            area[f] = area_from(surface.geometry(), r);
            let sides = mesh.face_halfedges(f);
            let directions = [0.0, PI - angles[1], PI + angles[0]];
            for k in 0..3 {
                (corner[sides[k]], direction[sides[k]]) = (angles[k], directions[k]);
                length[sides[k]] = surface.lengths()[sides[k].edge()];
            }
        }
        FaceFrames { corner, direction, area, length }
    }

    /// The energy `Σ w |z_g − r z_f|² + Σ c |z_f − q_f|²` of fourth powers z of directions, w being lengths of edges over those of their
    /// duals; faces at features have theirs.
    fn energy(&self, mesh: &Mesh, sectors: &Sectors, guides: &[FieldGuide]) -> Result<FieldEnergy> {
        let n = mesh.n_faces();
        let mut energy = FieldEnergy {
            fixed: self.along_features(mesh, sectors),
            pairs: Vec::with_capacity(mesh.n_edges()),
            pull: vec![([0.0; 2], 0.0); n],
            mass: self.area.iter().copied().collect(),
        };
        for e in mesh.edges() {
            let h = e.halfedge();
            if let (Some(f), Some(g), false) = (mesh.face(h), mesh.face(h.twin()), sectors.is_feature(e)) {
                let dual = (self.area[f] + self.area[g]).max(f64::MIN_POSITIVE);
                let weight = 3.0 * self.length[h] * self.length[h] / dual;
                let rotation = fourth_power(self.direction[h.twin()] - self.direction[h]);
                energy.pairs.push(FacePair { faces: [f.index(), g.index()], weight, rotation });
            }
        }
        for &FieldGuide { face, angle, weight } in guides {
            if face.index() >= n {
                return Err(Error::argument("face of a guide", face, "an existing face"));
            }
            if !angle.is_finite() || !weight.is_finite() || weight < 0.0 {
                let value = format!("{angle} of weight {weight}");
                return Err(Error::argument(
                    "guide",
                    value,
                    "a finite angle and a weight that is not negative",
                ));
            }
            let (q, c) = &mut energy.pull[face.index()];
            *q = add(*q, scale(weight, fourth_power(angle)));
            *c += weight;
        }
        Ok(energy)
    }

    /// Per face at features the fourth power of their direction.
    fn along_features(&self, mesh: &Mesh, sectors: &Sectors) -> Vec<Option<Complex>> {
        let of_face = |f| {
            let sides = mesh.face_halfedges(f);
            let ours: Vec<Complex> = sides
                .into_iter()
                .filter(|h| sectors.is_feature(h.edge()))
                .map(|h| fourth_power(self.direction[h]))
                .collect();
            let sum = ours.iter().fold([0.0; 2], |sum, &z| add(sum, z));
            if norm(sum) > CONTRADICTION { Some(unit(sum)) } else { ours.first().copied() }
        };
        mesh.faces().map(of_face).collect()
    }
}

/// Two faces with a common edge: z of the first, turned, is to be z of the second.
struct FacePair {
    faces: [usize; 2],
    weight: f64,
    rotation: Complex,
}

/// The energy of a field.
struct FieldEnergy {
    fixed: Vec<Option<Complex>>,
    pairs: Vec<FacePair>,
    /// Per face the sum of what guides ask for, and of their weights.
    pull: Vec<(Complex, f64)>,
    mass: Vec<f64>,
}

impl FieldEnergy {
    /// The field of least energy; of least energy for its size where nothing is asked for.
    fn least(&self, control: &Control) -> Result<Vec<Complex>> {
        let mut number = 0;
        let unknown: Vec<Option<usize>> = self
            .fixed
            .iter()
            .map(|z| {
                let next = z.is_none().then_some(number);
                number += if z.is_none() { 2 } else { 0 };
                next
            })
            .collect();
        let (pattern, values, mut right) = self.equations(&unknown, number)?;
        control.check()?;
        let mut cholesky = Cholesky::analyse(&pattern)?;
        control.check()?;
        let failed = |_| Error::Factorisation {
            size: number,
            message: "the energy of fields of directions is not positive definite".into(),
        };
        cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(failed)?;
        control.check()?;
        let asks = self.fixed.iter().any(Option::is_some) || self.pull.iter().any(|pull| pull.1 > 0.0);
        if asks {
            cholesky.solve(&mut right);
        } else {
            let mut random = SplitMix64::new(1);
            right = (0..number).map(|_| random.unit() - 0.5).collect();
            for _ in 0..STEPS {
                control.check()?;
                right.iter_mut().enumerate().for_each(|(i, x)| *x *= self.mass[i / 2]);
                cholesky.solve(&mut right);
                let size = right.iter().map(|x| x * x).sum::<f64>().sqrt();
                right.iter_mut().for_each(|x| *x /= size);
            }
        }
        let of = |(z, i): (&Option<Complex>, &Option<usize>)| match (z, i) {
            (Some(z), _) => *z,
            (None, Some(i)) => [right[*i], right[i + 1]],
            (None, None) => [1.0, 0.0],
        };
        Ok(self.fixed.iter().zip(&unknown).map(of).collect())
    }

    /// The matrix and the right side of the field of least energy.
    fn equations(&self, unknown: &[Option<usize>], n: usize) -> Result<(Pattern, Vec<f64>, Vec<f64>)> {
        let both = |pair: &FacePair| Some((unknown[pair.faces[0]]?, unknown[pair.faces[1]]?));
        let block = |(i, j): (usize, usize)| [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)];
        let entries = self.pairs.iter().filter_map(both).flat_map(block);
        let pattern = Pattern::new(n, &entries.map(|(i, j)| (i as u32, j as u32)).collect::<Vec<_>>())?;
        let (mut values, mut right) = (vec![0.0; pattern.entries()], vec![0.0; n]);
        let mut pull = |i: usize, z: Complex| {
            right[i] += z[0];
            right[i + 1] += z[1];
        };
        let mut diagonal = vec![0.0; n];
        for FacePair { faces: [f, g], weight, rotation } in &self.pairs {
            let [i, j] = [unknown[*f], unknown[*g]];
            [i, j].into_iter().flatten().for_each(|k| diagonal[k] += weight);
            match (i, j) {
                (Some(i), Some(j)) => {
                    let [a, b] = *rotation;
                    for (row, column, x) in [(j, i, a), (j, i + 1, -b), (j + 1, i, b), (j + 1, i + 1, a)] {
                        if let Some(at) = pattern.position(row, column) {
                            // A face beside itself has one such product, of which the diagonal has two.
                            values[at] -= if i == j { 2.0 * weight * x } else { weight * x };
                        }
                    }
                }
                (Some(i), None) => {
                    pull(i, scale(*weight, mul(conj(*rotation), self.fixed[*g].unwrap_or_default())))
                }
                (None, Some(j)) => {
                    pull(j, scale(*weight, mul(*rotation, self.fixed[*f].unwrap_or_default())))
                }
                (None, None) => {}
            }
        }
        for (i, (q, c)) in unknown.iter().zip(&self.pull).filter_map(|(i, pull)| i.map(|i| (i, pull))) {
            pull(i, *q);
            diagonal[i] += c;
        }
        let mean = diagonal.iter().sum::<f64>() / (n / 2).max(1) as f64;
        for i in (0..n).step_by(2) {
            (i..i + 2).for_each(|k| values[pattern.diagonal(k)] += diagonal[i] + SHIFT * mean);
        }
        Ok((pattern, values, right))
    }
}
