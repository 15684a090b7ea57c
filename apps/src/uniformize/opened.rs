//! The surface opened as pictures show it: along the geodesic sides of its Dirichlet domain, or along edges.

use super::model_place::ModelPlace;
use super::outline::{OutlineSide, loops_on_surface};
use super::pieces::{ConvexPieces, PieceCorner, WeldedPieces, split, whole};
use super::quotient::{ORIGIN, Uniformized};
use super::tiling::Prototype;
use crate::surface_layout::SurfaceLayout;
use crate::uv;
use ricci::embed::DirichletDomain;
use ricci::geometry::vector::dot;
use ricci::geometry::{DoubleDouble, Motion, Space};

/// Largest distance of a point that counts as lying on a side, as a share of the terms that the distance is the sum of: deck elements are
/// known to this precision.
const ON_SIDE: f64 = 1e-8;
/// Most cuts of one triangle and its pieces. No surface comes near this; with wrong deck elements the cuts would never end.
const MOST_CUTS: usize = 10_000;

/// An opened surface.
pub struct CutOpenSurface {
    /// The domain that drawings copy.
    pub shape: Prototype,
    /// The triangles in space with the cut, numbered by its pairs of sides, if the surface has positions.
    pub in_space: Option<WeldedPieces>,
}

impl CutOpenSurface {
    /// Cut along edges, as the layout is; the loops of the generators stand for the cut.
    pub fn along_edges(u: &Uniformized, laid: &SurfaceLayout, sides: &[OutlineSide]) -> CutOpenSurface {
        let border = sides.iter().flat_map(|s| &s.points[..s.points.len().saturating_sub(1)]).copied();
        let shape = Prototype {
            points: laid.layout.points.clone(),
            triangles: uv::corners(laid.mesh(), laid.corner_index()),
            border: border.collect(),
            centre: ORIGIN,
        };
        let (triangles, cut) = (laid.mesh().triangles(), loops_on_surface(u));
        CutOpenSurface {
            shape,
            in_space: laid.positions.clone().map(|points| WeldedPieces { points, triangles, cut }),
        }
    }

    /// Cut along the sides of the Dirichlet domain: the part of a triangle that lies across a side is moved into the domain.
    pub fn along_geodesics(laid: &SurfaceLayout, domain: &DirichletDomain, at: ModelPlace) -> CutOpenSurface {
        let folding = Folding::new(domain, if at == ModelPlace::Plane { Space::E2 } else { Space::H2 });
        let (pairs, mesh) = (pairs(domain), laid.mesh());
        let mut pieces = ConvexPieces::default();
        for f in mesh.faces() {
            for piece in folding.pieces(whole(mesh.face_halfedges(f).map(|h| laid.layout.corner(h)))) {
                pieces.add(f, &piece, |p, q| folding.along(p, q).map(|k| pairs[k]));
            }
        }
        let WeldedPieces { points, triangles, .. } = pieces.welded(&pieces.places);
        let in_space = laid.positions.as_ref().map(|positions| pieces.in_space(mesh, positions));
        let shape = Prototype { points, triangles, border: border(domain, at), centre: domain.centre };
        CutOpenSurface { shape, in_space }
    }
}

/// The number of each side's pair.
pub fn pairs(domain: &DirichletDomain) -> Vec<usize> {
    let first = |k: usize| k.min(domain.partner[k].unwrap_or(k));
    let leads = |k: &usize| first(*k) == *k;
    (0..domain.sides.len()).map(|k| (0..first(k)).filter(leads).count()).collect()
}

/// The border of the domain as a polygon that follows its geodesics.
fn border(domain: &DirichletDomain, at: ModelPlace) -> Vec<[f64; 3]> {
    let n = domain.corners.len();
    let side = |k: usize| {
        let mut points = at.geodesic(domain.corners[k], domain.corners[(k + 1) % n]);
        points.pop();
        points
    };
    (0..n).flat_map(side).collect()
}

/// The sides of a Dirichlet domain, with the motions that bring the neighbour across each side into the domain.
struct Folding {
    space: Space,
    /// Linear functions of ambient coordinates: positive across the side.
    across: Vec<[f64; 3]>,
    back: Vec<Motion<DoubleDouble>>,
}

impl Folding {
    fn new(domain: &DirichletDomain, space: Space) -> Folding {
        let c = domain.centre;
        // A point is across a side if it is nearer to the image of the centre than to the centre, by the cosh of the distances in H², by
        // their squares in E².
        let across = domain.neighbours().map(|side| {
            let i = side.motion.apply(c.map(DoubleDouble::from)).map(f64::from);
            let square = |p: [f64; 3]| p[0] * p[0] + p[1] * p[1];
            match space {
                Space::H2 => [i[0] - c[0], i[1] - c[1], c[2] - i[2]],
                _ => [2.0 * (i[0] - c[0]), 2.0 * (i[1] - c[1]), square(c) - square(i)],
            }
        });
        let back = domain.neighbours().map(|side| side.motion.inverse()).collect();
        Folding { space, across: across.collect(), back }
    }

    /// A measure of how far a point is across a side: 0 on it, negative on the domain's own part.
    fn beyond(&self, side: usize, p: [f64; 3]) -> f64 {
        let form = self.across[side];
        let size: f64 = (0..3).map(|k| (form[k] * p[k]).abs()).sum();
        let value = dot(form, p);
        if value.abs() <= ON_SIDE * size { 0.0 } else { value }
    }

    /// The side that two points lie on.
    fn along(&self, p: [f64; 3], q: [f64; 3]) -> Option<usize> {
        (0..self.across.len()).find(|&k| self.beyond(k, p) == 0.0 && self.beyond(k, q) == 0.0)
    }

    /// The pieces of a triangle, moved into the domain.
    fn pieces(&self, triangle: Vec<PieceCorner>) -> Vec<Vec<PieceCorner>> {
        let (mut inside, mut waiting, mut cuts) = (Vec::new(), vec![triangle], 0);
        while let Some(piece) = waiting.pop() {
            let farthest = |k: usize| piece.iter().map(|c| self.beyond(k, c.0)).fold(0.0, f64::max);
            let crossed = (0..self.across.len()).map(|k| (farthest(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, side)) = crossed.filter(|(far, _)| *far > 0.0 && cuts < MOST_CUTS) else {
                inside.push(piece);
                continue;
            };
            cuts += 1;
            let [near, mut beyond] = split(&piece, self.space, |p| self.beyond(side, p));
            for (p, _) in &mut beyond {
                *p = self.back[side].apply(p.map(DoubleDouble::from)).map(f64::from);
            }
            waiting.extend([near, beyond].into_iter().filter(|part| !part.is_empty()));
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::embed::DeckElement;
    use ricci::geometry::vector::{norm, triangle_normal};

    /// The unit square around the origin, whose opposite sides are glued by translations.
    fn square() -> DirichletDomain {
        let side = |[x, y]: [f64; 2]| {
            let motion = Motion { a: [1.0, 0.0], b: [0.5 * x, 0.5 * y], ..Motion::identity(Space::E2) };
            DeckElement { word: Default::default(), motion: motion.precise() }
        };
        DirichletDomain {
            centre: ORIGIN,
            corners: [[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]].map(|[x, y]| [x, y, 1.0]).to_vec(),
            sides: [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(side).to_vec(),
            partner: [2, 3, 0, 1].map(Some).to_vec(),
            area: 1.0,
            radius: 0.5f64.sqrt(),
        }
    }

    #[test]
    fn what_lies_across_sides_is_moved_into_the_domain_and_cut_along_them() {
        let folding = Folding::new(&square(), Space::E2);
        assert_eq!(pairs(&square()), [0, 1, 0, 1]);
        let triangles = [
            [[0.1, 0.1], [0.3, 0.1], [0.1, 0.2]],
            [[0.3, 0.1], [1.9, 0.4], [0.2, 2.7]],
            // One of its sides lies on a side of the domain.
            [[0.5, -0.2], [0.9, 0.1], [0.5, 0.3]],
        ];
        let mut cuts = Vec::new();
        for triangle in triangles {
            let corners = triangle.map(|[x, y]| [x, y, 1.0]);
            let doubled = |c: [[f64; 3]; 3]| norm(triangle_normal(c));
            let (mut sum, mut shares, mut cut) = (0.0, 0.0, 0);
            for piece in folding.pieces(whole(corners)) {
                for (i, (p, b)) in piece.iter().enumerate() {
                    assert!(p[0].abs().max(p[1].abs()) <= 0.5 + 1e-7, "{p:?}");
                    // The barycentric coordinates name the same point up to a translation of the lattice.
                    let off = [0, 1].map(|k| (0..3).map(|j| b[j] * corners[j][k]).sum::<f64>() - p[k]);
                    assert!(off.iter().all(|x| (x - x.round()).abs() < 1e-7), "{off:?}");
                    cut += usize::from(folding.along(*p, piece[(i + 1) % piece.len()].0).is_some());
                }
                for i in 2..piece.len() {
                    sum += doubled([piece[0].0, piece[i - 1].0, piece[i].0]);
                    shares += doubled([piece[0].1, piece[i - 1].1, piece[i].1]);
                }
            }
            assert!((sum - doubled(corners)).abs() < 1e-7 && (shares - 3f64.sqrt()).abs() < 1e-7);
            cuts.push(cut);
        }
        assert!(cuts[0] == 0 && cuts[1] > 6 && cuts[2] == 1, "{cuts:?}");
    }
}
