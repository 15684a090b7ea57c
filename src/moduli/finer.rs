//! A flat surface on finer and finer triangulations, with lengths whose errors are bounded and with closed forms of integer values.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::{Enclosure, worse};
use crate::harmonic::HarmonicForms;
use crate::mesh::{EdgeId, FaceId, FixedEdges, HalfedgeId, Mesh, PerEdge, PerFace};
use crate::metric::flip_queue::{FlipQueue, Flippable, allowance, between_faces, endless};

/// A surface of flat triangles, whose triangulation is refined by midpoints of edges and by isometric flips.
///
/// Enclosures of lengths that are made of lengths grow from one refinement to the next. After each the centres are taken for exact lengths,
/// of a surface that differs from the given one by no more than `distortion`.
#[derive(Debug, Clone)]
pub struct BisectedSurface {
    /// The triangulation.
    pub mesh: Mesh,
    /// Enclosures of the Euclidean lengths of the edges, in units of [`BisectedSurface::unit`] (E entries).
    pub lengths: PerEdge<Enclosure>,
    /// The unit of lengths: a power of two.
    pub unit: f64,
    /// The energies of forms on the given surface are at most 1 + distortion times those on the surface with these lengths.
    pub distortion: f64,
    /// Per class of forms, the integral of a closed form with integer values over the half-edge 2e of every edge e (E entries each).
    pub cochains: Vec<PerEdge<i32>>,
    /// Per edge, true if forms have a quadratic term there (E entries).
    pub is_curved: PerEdge<bool>,
}

/// Range of the lengths over the longest one within which the error bounds of [`Enclosure`] hold for fourth powers.
const LEAST_LENGTH: f64 = 1e-35;
/// Largest |a² + b² − x²| / (a b) over the two triangles of an edge x, summed, that counts as 0, so that cocircular edges are not flipped.
const COCIRCULAR: f64 = 1e-10;

impl BisectedSurface {
    /// The domain of some forms, with exactly the lengths that it has.
    ///
    /// # Errors
    /// [`Error::EdgeLength`] for lengths more than 1e35 apart.
    pub(super) fn new(forms: &HarmonicForms) -> Result<BisectedSurface> {
        let (mesh, lengths) = (Mesh::clone(forms.domain.mesh()), forms.domain.lengths());
        let longest = lengths.iter().fold(0.0f64, |most, &l| most.max(l));
        let unit = 2f64.powi(longest.log2().ceil() as i32);
        if let Some(edge) = lengths.iter().position(|&l| l < LEAST_LENGTH * longest) {
            return Err(Error::EdgeLength { edge, length: lengths[EdgeId::from(edge)] });
        }
        let n = mesh.n_edges();
        let cochains = forms.cochains.iter().map(|cochain| {
            let mut values = PerEdge::filled(n, 0);
            cochain.0.iter().for_each(|&(e, x)| values[e] = x);
            values
        });
        Ok(BisectedSurface {
            lengths: PerEdge::from_fn(n, |e| Enclosure::from(lengths[e] / unit)),
            cochains: cochains.collect(),
            is_curved: PerEdge::filled(n, false),
            distortion: 0.0,
            unit,
            mesh,
        })
    }

    /// The integral of closed form k over a half-edge, in its direction.
    pub(super) fn along(&self, k: usize, h: HalfedgeId) -> i32 {
        along(&self.cochains[k], h)
    }

    /// True if forms have a quadratic term on a side of the face.
    pub(super) fn has_curved_side(&self, f: FaceId) -> bool {
        self.mesh.opposite_edges(f).iter().any(|&e| self.is_curved[e])
    }

    /// Parts an edge, and the faces beside it, at its midpoint. False, and nothing done, for one with the same face on both sides.
    pub(super) fn halve(&mut self, e: EdgeId) -> bool {
        let h = e.halfedge();
        if !between_faces(&self.mesh, h) {
            return false;
        }
        let [bc, ca, ad, db] = self.mesh.quadrilateral(h);
        let x = self.lengths[e];
        let median = |a: HalfedgeId, b: HalfedgeId| {
            let [a, b] = [a, b].map(|side| self.lengths[side.edge()]);
            ((a * a + b * b).times_power(2.0) - x * x).sqrt().times_power(0.5)
        };
        let medians = [median(bc, ca), median(ad, db)];
        let is_curved = [h, h.twin()].map(|h| self.mesh.face(h).is_some_and(|f| self.has_curved_side(f)));
        // The first half keeps the value of the edge, the second has 0; those beside it close the triangles.
        let values: Vec<[i32; 2]> = (0..self.cochains.len())
            .map(|k| [self.along(k, bc), self.along(k, ad) - self.along(k, h)])
            .collect();
        self.mesh.insert_on_edge(e);
        let half = x.times_power(0.5);
        self.lengths[e] = half;
        self.lengths.extend([half, medians[0], medians[1]]);
        self.is_curved.extend([self.is_curved[e], is_curved[0], is_curved[1]]);
        self.cochains
            .iter_mut()
            .zip(values)
            .for_each(|(cochain, [left, right])| cochain.extend([0, left, right]));
        true
    }

    /// Takes the centres of lengths for exact, given the cotangents of these lengths.
    ///
    /// Where the cotangents of a triangle change by at most ρ, `Σ cot p²/2` changes by at most `ρ Σ p²/2`, which is at most 2 ρ Σ cot times
    /// it: on the plane Σ p = 0 the eigenvalues of the form Σ cot p² have the sum (2/3) Σ cot and the product 1/3.
    pub(super) fn take_centres(&mut self, cotangents: &PerFace<[Enclosure; 3]>) {
        let of_face = |cot: &[Enclosure; 3]| {
            let change = cot.iter().fold(0.0, |most, x| worse(most, 2.0 * x.radius()));
            2.0 * change * (cot[0] + cot[1] + cot[2]).upper()
        };
        let most = cotangents.iter().map(of_face).fold(0.0, worse);
        self.distortion = (self.distortion + most + self.distortion * most) * (1.0 + 1e-12);
        self.lengths.iter_mut().for_each(|l| *l = Enclosure::new(l.centre(), 0.0));
    }

    /// Flips until every edge is Delaunay. Returns the number of flips.
    ///
    /// # Errors
    /// [`Error::Connectivity`] where the flips do not end; [`Error::Cancelled`].
    pub(super) fn make_delaunay(&mut self, control: &Control) -> Result<usize> {
        let BisectedSurface { mesh, lengths, cochains, is_curved, .. } = self;
        let most = allowance(mesh.n_edges());
        let mut queue = FlipQueue::all(mesh, &FixedEdges::none());
        let decide = |mesh: &Mesh, lengths: &PerEdge<Enclosure>, h| other_diagonal(mesh, lengths, h);
        let mut record = |mesh: &Mesh, flip: crate::mesh::Flip<Enclosure>| {
            let [bc, ca, ad, db] = mesh.quadrilateral(flip.edge.halfedge());
            cochains.iter_mut().for_each(|c| c[flip.edge] = along(c, db) + along(c, bc));
            is_curved[flip.edge] |= [bc, ca, ad, db].iter().any(|side| is_curved[side.edge()]);
        };
        let mut flippable = Flippable { mesh, values: lengths, decide, record: &mut record };
        let flips = queue.flip_until_empty(most, &mut flippable, control)?;
        if queue.is_empty() { Ok(flips) } else { Err(endless("flips of a finer triangulation do not end")) }
    }

    /// The lengths in the unit of the given surface, in double-double precision: `[high, low]` (E entries).
    pub fn double_lengths(&self) -> PerEdge<[f64; 2]> {
        PerEdge::from_fn(self.mesh.n_edges(), |e| {
            let length = self.lengths[e].centre();
            [length.high * self.unit, length.low * self.unit]
        })
    }
}

fn along(cochain: &PerEdge<i32>, h: HalfedgeId) -> i32 {
    let value = cochain[h.edge()];
    if h.0 & 1 == 0 { value } else { -value }
}

/// The length of the other diagonal of an edge that is not Delaunay; `None` for one that is, or whose flip leaves no bounds.
fn other_diagonal(mesh: &Mesh, lengths: &PerEdge<Enclosure>, h: HalfedgeId) -> Option<Enclosure> {
    let [bc, ca, ad, db] = mesh.quadrilateral(h).map(|side| lengths[side.edge()]);
    let x = lengths[h.edge()];
    let excess = |a: Enclosure, b: Enclosure| {
        let [a, b, x] = [a, b, x].map(Enclosure::nearest);
        ((a - x) * (a + x) + b * b) / (a * b)
    };
    if excess(bc, ca) + excess(ad, db) >= -COCIRCULAR {
        return None;
    }
    // The corners opposite the edge, which lies on the x axis from a = 0 to b.
    let corner = |to_a: Enclosure, to_b: Enclosure| {
        let along = ((to_a - to_b) * (to_a + to_b) + x * x) / x.times_power(2.0);
        let height = double_area(x, to_a, to_b) / x;
        (along, height)
    };
    let ((cx, cy), (dx, dy)) = (corner(ca, bc), corner(ad, db));
    let length = ((cx - dx) * (cx - dx) + (cy + dy) * (cy + dy)).sqrt();
    let areas = [double_area(length, ca, ad), double_area(length, bc, db)];
    (length.radius() < 1e-15 * length.nearest() && areas.iter().all(|a| a.is_positive())).then_some(length)
}

/// Twice the area of a triangle.
pub(super) fn double_area(a: Enclosure, b: Enclosure, c: Enclosure) -> Enclosure {
    let sums = [a + b + c, (b - a) + c, (a - b) + c, (a + b) - c];
    ((sums[0] * sums[1]) * (sums[2] * sums[3])).sqrt().times_power(0.5)
}
